// The examples of docs/user/lowering.md on doubles: what they say they compute.
#include <gtest/gtest.h>

#include <cmath>

#include "docs/examples/lowering/colour_transform.h"
#include "docs/examples/lowering/kalman_update.h"
#include "docs/examples/lowering/point_segment.h"
#include "docs/examples/lowering/ray_triangle.h"
#include "hls/kernel/fixed.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

Vector3<double> drawn(Random& random) {
  const Point p = random.point(-1, 1);
  return {p.x(), p.y(), p.z()};
}

TEST(Examples, WhiteAndBlueHaveTheirColours) {
  const Ycbcr<double> white = colour_transform(Rgb<double>{1, 1, 1});
  EXPECT_NEAR(white.y, 1, 1e-7);
  EXPECT_NEAR(white.cb, 0, 1e-7);
  EXPECT_NEAR(colour_transform(Rgb<double>{0, 0, 1}).cb, 0.5, 1e-7);
  EXPECT_NEAR(colour_transform(Rgb<double>{1, 0, 0}).cr, 0.5, 1e-7);
  EXPECT_EQ(colour_transform(Rgb<double>{2, 2, 2}).y, 1);
}

// In 18 bits the transform is as near as its roundings allow: half a unit of each of its six
// products and constants.
TEST(Examples, FixedPointColoursAreNearTheReals) {
  using Number = Fixed<18, 16>;
  constexpr double kError = 6 * 0x1p-17;
  Random random(7);
  for (int i = 0; i < 10000; ++i) {
    const Rgb<Number> in{Number(random.uniform(0, 1)), Number(random.uniform(0, 1)),
                         Number(random.uniform(0, 1))};
    const auto real = [](const Number& number) { return static_cast<double>(number); };
    const Ycbcr<double> exact =
        colour_transform(Rgb<double>{real(in.red), real(in.green), real(in.blue)});
    const Ycbcr<Number> fixed = colour_transform(in);
    ASSERT_NEAR(real(fixed.y), exact.y, kError);
    ASSERT_NEAR(real(fixed.cb), exact.cb, kError);
    ASSERT_NEAR(real(fixed.cr), exact.cr, kError);
  }
}

// The nearest of many points of the segment.
TEST(Examples, SegmentIsAsFarAsItsNearestPoint) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Vector3<double> p = drawn(random);
    Segment<double> segment{drawn(random), drawn(random)};
    if (i % 10 == 0) segment.to = segment.from;
    double nearest = 10;
    constexpr int kSteps = 1000;
    for (int k = 0; k <= kSteps; ++k) {
      const double s = static_cast<double>(k) / kSteps;
      const auto away = [&](double of, double from, double to) {
        return of - (1 - s) * from - s * to;
      };
      nearest = std::min(nearest, std::hypot(away(p.x, segment.from.x, segment.to.x),
                                             away(p.y, segment.from.y, segment.to.y),
                                             away(p.z, segment.from.z, segment.to.z)));
    }
    const double found = point_segment(p, segment);
    EXPECT_LE(found, nearest + 1e-12);
    EXPECT_GT(found, nearest - 3e-3);
  }
}

// A ray towards a point of the triangle's plane hits if its barycentric coordinates say so.
TEST(Examples, RayHitsTheTriangleAtThePointAimedAt) {
  Random random(6);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Corners<double> t{drawn(random), drawn(random), drawn(random)};
    const Vector3<double> origin = drawn(random);
    const double u = random.uniform(-0.5, 1), v = random.uniform(-0.5, 1);
    const auto towards = [&](double a, double b, double c, double from) {
      return (1 - u - v) * a + u * b + v * c - from;
    };
    const Ray<double> ray{
        origin,
        {towards(t.a.x, t.b.x, t.c.x, origin.x), towards(t.a.y, t.b.y, t.c.y, origin.y),
         towards(t.a.z, t.b.z, t.c.z, origin.z)}};
    const Hit<double> hit = ray_triangle(ray, t);
    EXPECT_NEAR(hit.t, 1, 1e-6);
    EXPECT_NEAR(hit.u, u, 1e-6);
    EXPECT_NEAR(hit.v, v, 1e-6);
    EXPECT_EQ(hit.hit, u >= 0 && v >= 0 && u + v <= 1);
    hits += hit.hit;
  }
  EXPECT_GT(hits, 20);
  EXPECT_LT(hits, 180);
}

// Of two independent measurements of one variance: their mean, with half of the variance.
TEST(Examples, MeasurementsAreWeighedByTheirVariances) {
  const State<double> updated = kalman_update(State<double>{1, 0, 4, 2, 5}, 3.0, 4.0);
  EXPECT_DOUBLE_EQ(updated.position, 2);
  EXPECT_DOUBLE_EQ(updated.velocity, 0.5);
  EXPECT_DOUBLE_EQ(updated.var_position, 2);
  EXPECT_DOUBLE_EQ(updated.covariance, 1);
  EXPECT_DOUBLE_EQ(updated.var_velocity, 4.5);
}

}  // namespace
}  // namespace emax
