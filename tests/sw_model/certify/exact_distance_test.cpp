#include "sw_model/certify/exact_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "tests/support/long_double_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using Corners = std::array<Point, 3>;

double size_of(const Point& p, const Corners& corners) {
  return std::max({(corners[0] - p).norm(), (corners[1] - p).norm(), (corners[2] - p).norm()});
}

// The reference's own error, two units of 2^-62, is taken off both comparisons.
::testing::AssertionResult holds(const DistanceBounds& bounds, const Point& p,
                                 const Corners& corners) {
  const long double exact = test::long_double_distance(p, corners);
  const long double slack = 0x1p-61L * size_of(p, corners);
  if (bounds.lower <= exact + slack && exact - slack <= bounds.upper) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure()
         << bounds.lower << ".." << bounds.upper << " does not hold " << static_cast<double>(exact)
         << " for p " << p.transpose() << ", corners " << corners[0].transpose() << " | "
         << corners[1].transpose() << " | " << corners[2].transpose();
}

Corners random_corners(test::Random& random) {
  const Point a = random.point(-1, 1), b = random.point(-1, 1);
  const double ratio = std::pow(10.0, random.uniform(-16, 0));
  const Point in_line = a + random.uniform(-1, 2) * (b - a);
  switch (random.below(5)) {
    case 0:
      return {a, b, random.point(-1, 1)};
    case 1:
      return {a, in_line + ratio * random.point(-1, 1), b};
    case 2:
      return {b, a, b + ratio * random.point(-1, 1)};
    case 3:
      return {a, in_line, b};
    default:
      return {a, a, random.below(2) == 0 ? a : b};
  }
}

Point random_point_near(test::Random& random, const Corners& corners) {
  const double u = random.uniform(-0.5, 1.5), v = random.uniform(-0.5, 1.5);
  const double off = random.below(4) == 0 ? 0 : std::pow(10.0, random.uniform(-12, 1));
  return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]) +
         off * random.point(-1, 1);
}

TEST(ExactDistance, KnowsTheSevenRegionsOfATriangle) {
  const Corners t = {Point(0, 0, 0), Point(4, 0, 0), Point(0, 3, 0)};
  const auto expect = [&t](const Point& p, double distance) {
    const DistanceBounds d = point_triangle_distance(p, t);
    EXPECT_LE(d.lower, distance) << p.transpose();
    EXPECT_GE(d.upper, distance) << p.transpose();
    EXPECT_NEAR(d.lower, distance, 5e-14);
    EXPECT_NEAR(d.upper, distance, 5e-14);
  };
  expect(Point(1, 1, 2), 2);    // face
  expect(Point(-3, -4, 0), 5);  // vertices
  expect(Point(7, -4, 0), 5);
  expect(Point(-3, 7, 0), 5);
  expect(Point(2, -3, 4), 5);  // edges
  expect(Point(-4, 2, 3), 5);
  expect(Point(5, 5.5, 0), 5);    // nearest (2, 1.5) on the long edge
  expect(Point(0.5, 0.5, 0), 0);  // on it
}

TEST(ExactDistance, HoldsTheExactValueAndIsTight) {
  test::Random random(51);
  double widest = 0;
  for (int i = 0; i < 200000; ++i) {
    const Corners corners = random_corners(random);
    const Point p = random_point_near(random, corners);
    const DistanceBounds d = point_triangle_distance(p, corners);
    ASSERT_TRUE(holds(d, p, corners)) << "seed 51, " << i;
    const double exact = static_cast<double>(test::long_double_distance(p, corners));
    widest = std::max(widest, (d.upper - exact) / size_of(p, corners));
  }
  std::printf("upper - exact, relative to |V - P|: %.3g\n", widest);
  EXPECT_LT(widest, 32 * 0x1p-53);
}

TEST(ExactDistance, LowerBoundIsUseful) {
  test::Random random(52);
  for (int i = 0; i < 20000; ++i) {
    const Corners corners = {random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
    const Point p = random.point(-3, 3);
    const DistanceBounds d = point_triangle_distance(p, corners);
    if (d.upper < 1e-2) continue;
    ASSERT_GT(d.lower, d.upper * (1 - 1e-11)) << "seed 52, " << i;
  }
}

TEST(ExactDistance, LosesNothingFarFromTheOrigin) {
  test::Random random(53);
  for (int i = 0; i < 50000; ++i) {
    const Point origin(1e7, -2e7, 5e6);
    Corners corners;
    for (Point& c : corners) c = origin + 1e-3 * random.point(-1, 1);
    const Point p = origin + 2e-3 * random.point(-1, 1);
    const DistanceBounds d = point_triangle_distance(p, corners);
    ASSERT_TRUE(holds(d, p, corners)) << "seed 53, " << i;
    // Millimetres at 1e7: one unit in the last place of a coordinate is 2e-9.
    const double exact = static_cast<double>(test::long_double_distance(p, corners));
    ASSERT_LT(d.upper - exact, 3e-17) << "seed 53, " << i;
  }
}

TEST(ExactDistance, WorksAtAnyScale) {
  test::Random random(54);
  for (const double scale : {1e-200, 1e-160, 1e-150, 1e-30, 1e30, 1e149}) {
    for (int i = 0; i < 2000; ++i) {
      Corners corners;
      for (Point& c : corners) c = random.point(-1, 1);
      const Point p = random.point(-2, 2);
      Corners scaled;
      for (std::size_t k = 0; k < 3; ++k) scaled[k] = scale * corners[k];
      const DistanceBounds d = point_triangle_distance(scale * p, scaled);
      const long double exact = test::long_double_distance(scale * p, scaled);
      ASSERT_GE(d.upper, exact) << "seed 54, scale " << scale << ", " << i;
      ASSERT_LE(d.lower, exact) << "seed 54, scale " << scale << ", " << i;
    }
  }
}

TEST(ExactDistance, IsZeroOnAVertex) {
  const Corners t = {Point(1e7, 0.1, 0.3), Point(4, 0, 0), Point(0, 3, 0)};
  for (const Point& p : t) {
    EXPECT_EQ(point_triangle_distance(p, t).upper, 0);
    EXPECT_EQ(point_triangle_distance(p, t).lower, 0);
  }
}

TEST(ExactDistance, RefusesToWorkWithSubnormalsFlushed) {
  const Corners t = {Point(0, 0, 0), Point(4, 0, 0), Point(0, 3, 0)};
  const test::Stimulus s = test::bumpy_sphere(4, 4, 1, 1);
  const ExactMesh mesh(s.mesh());
  const ScopedFlushMode flush;
  EXPECT_THROW(point_triangle_distance(Point(0, 0, 1), t), std::logic_error);
  EXPECT_THROW(mesh.distance(Point(0, 0, 1)), std::logic_error);
  EXPECT_THROW(ExactMesh{s.mesh()}, std::logic_error);
}

// The tree against all triangles: the same bits and the same lowest index.
TEST(ExactMesh, EqualsBruteForce) {
  for (const test::Stimulus& s : test::all_stimuli(61)) {
    SCOPED_TRACE(s.name + ", seed 61");
    const ExactMesh tree(s.mesh());
    for (const Point& p : s.cloud) {
      ExactMesh::Nearest brute = {{INFINITY, INFINITY}, 0};
      for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
        const DistanceBounds d = point_triangle_distance(p, s.mesh().corners(t));
        ASSERT_EQ(tree.distance_to(p, t).upper, d.upper);
        brute.distance.lower = std::min(brute.distance.lower, d.lower);
        if (d.upper < brute.distance.upper) {
          brute.distance.upper = d.upper;
          brute.triangle = t;
        }
      }
      const ExactMesh::Nearest found = tree.nearest(p);
      ASSERT_EQ(found.distance.upper, brute.distance.upper);
      ASSERT_EQ(found.triangle, brute.triangle);
      ASSERT_GE(found.distance.lower, brute.distance.lower);
      ASSERT_LE(found.distance.lower, found.distance.upper);
    }
  }
}

// Parts one after the other give what the whole gives; the lower end holds, too.
TEST(ExactMesh, PartsGiveTheNearestOfTheWhole) {
  for (const test::Stimulus& s : test::all_stimuli(62)) {
    SCOPED_TRACE(s.name + ", seed 62");
    const MeshView mesh = s.mesh();
    const ExactMesh whole(mesh);
    for (const std::size_t size : {std::size_t{3}, std::size_t{40}}) {
      std::vector<ExactMesh::Nearest> least(s.cloud.size(), {{0, INFINITY}, 0});
      std::vector<double> lower(s.cloud.size(), INFINITY);
      for (std::size_t first = 0; first < mesh.triangles.size(); first += size) {
        const std::size_t count = std::min(size, mesh.triangles.size() - first);
        const MeshView part{mesh.vertices, mesh.triangles.subspan(first, count)};
        const ExactMesh exact(part);
        for (std::size_t i = 0; i < s.cloud.size(); ++i) {
          exact.lower(s.cloud[i], static_cast<std::uint32_t>(first), least[i]);
          const double upper = whole.nearest(s.cloud[i]).distance.upper;
          lower[i] = std::min(lower[i], lower_end(s.cloud[i], part, upper));
        }
      }
      for (std::size_t i = 0; i < s.cloud.size(); ++i) {
        const ExactMesh::Nearest found = whole.nearest(s.cloud[i]);
        ASSERT_EQ(least[i].distance.upper, found.distance.upper);
        ASSERT_EQ(least[i].triangle, found.triangle);
        ASSERT_LE(lower[i], found.distance.upper);
        ASSERT_GE(lower[i], found.distance.lower);
      }
    }
  }
}

TEST(ExactMesh, FindsTheSameFromAnySeed) {
  for (const test::Stimulus& s : test::all_stimuli(63)) {
    SCOPED_TRACE(s.name + ", seed 63");
    const ExactMesh tree(s.mesh());
    for (std::size_t i = 0; i < std::min<std::size_t>(s.cloud.size(), 100); ++i) {
      const ExactMesh::Nearest found = tree.nearest(s.cloud[i]);
      for (std::uint32_t seed = 0; seed < s.triangles.size(); seed += 7) {
        const ExactMesh::Nearest seeded = tree.nearest(s.cloud[i], -INFINITY, seed);
        ASSERT_EQ(seeded.distance.upper, found.distance.upper) << seed;
        ASSERT_EQ(seeded.triangle, found.triangle) << seed;
        ASSERT_LE(seeded.distance.lower, seeded.distance.upper) << seed;
      }
    }
  }
}

TEST(ExactMesh, StopsEarlyOnlyWithinWhatIsEnough) {
  const test::Stimulus s = test::bumpy_sphere(20, 30, 500, 62);
  const ExactMesh tree(s.mesh());
  int stopped_early = 0;
  for (const Point& p : s.cloud) {
    const double least = tree.nearest(p).distance.upper;
    const ExactMesh::Nearest coarse = tree.nearest(p, 2 * least);
    ASSERT_LE(coarse.distance.upper, 2 * least);
    ASSERT_GE(coarse.distance.upper, least);
    ASSERT_EQ(coarse.distance.upper, tree.distance_to(p, coarse.triangle).upper);
    stopped_early += coarse.distance.upper > least ? 1 : 0;
    ASSERT_EQ(tree.nearest(p, least / 2).distance.upper, least);
  }
  EXPECT_GT(stopped_early, 0);
}

const std::vector<Triangle> kOneTriangle = {{0, 1, 2}};

std::pair<Point, Corners> random_pair_of_any_scale(std::uint64_t seed) {
  test::Random random(seed);
  const double scale = std::pow(10.0, random.uniform(-130, 130));
  Corners corners = random_corners(random);
  const Point p = scale * random_point_near(random, corners);
  for (Point& corner : corners) corner *= scale;
  return {p, corners};
}

// Proven, and close to the bound of twice the cost, whatever the shape and the scale.
TEST(ExactMesh, BoundsTheDistanceToATriangleFromAbove) {
  for (std::uint64_t seed = 1; seed <= 20000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [p, corners] = random_pair_of_any_scale(seed);
    const ExactMesh mesh(MeshView{corners, kOneTriangle});
    const double upper = mesh.upper_to(p, 0);
    const double size = size_of(p, corners);
    ASSERT_GE(upper + 0x1p-61 * size, test::long_double_distance(p, corners));
    ASSERT_LE(upper, mesh.distance_to(p, 0).upper + 1e-9 * size);
  }
}

TEST(ExactMesh, TellsALikelyNearestTriangle) {
  for (const test::Stimulus& s : test::all_stimuli(64)) {
    SCOPED_TRACE(s.name + ", seed 64");
    const ExactMesh tree(s.mesh());
    for (const Point& p : s.cloud) {
      const double least = tree.nearest(p).distance.upper;
      const auto seed = static_cast<std::uint32_t>(s.triangles.size() / 2);
      for (const std::uint32_t likely : {tree.likely_nearest(p), tree.likely_nearest(p, seed)}) {
        const double size = size_of(p, s.mesh().corners(likely));
        ASSERT_LE(tree.distance_to(p, likely).upper, least + 1e-9 * size);
      }
    }
  }
}

// Corners and quick upper ends decide only where the upper end would, slivers and tiny limits
// included.
TEST(ExactMesh, IsWithinExactlyWhereTheUpperEndIs) {
  std::array<std::size_t, 2> seen{};
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [p, corners] = random_pair_of_any_scale(seed);
    const ExactMesh mesh(MeshView{corners, kOneTriangle});
    double nearest = INFINITY;
    for (const Point& corner : corners) nearest = std::min(nearest, (corner - p).norm());
    const double upper = mesh.distance_to(p, 0).upper;
    for (const double limit :
         {2 * nearest, 2.000001 * nearest, nearest, upper, std::nextafter(upper, 0), 3 * upper,
          upper * (1 + 0x1p-21), upper * (1 + 0x1p-20), upper * (1 + 0x1p-19), 0.0, -1.0}) {
      EXPECT_EQ(mesh.is_within(p, 0, limit), upper <= limit) << limit;
      ++seen[upper <= limit];
    }
  }
  EXPECT_GT(seen[0], 5000u);
  EXPECT_GT(seen[1], 5000u);
}

TEST(ExactMesh, RefusesWhatHasNoDistance) {
  const std::vector<Point> vertices = {Point(0, 0, 0), Point(1, 0, 0), Point(0, NAN, 0)};
  const std::vector<Triangle> none, broken = {{0, 1, 3}}, not_finite = {{0, 1, 2}};
  EXPECT_THROW(ExactMesh(MeshView{vertices, none}), Error);
  EXPECT_THROW(ExactMesh(MeshView{vertices, broken}), std::invalid_argument);
  EXPECT_THROW(ExactMesh(MeshView{vertices, not_finite}), Error);
}

}  // namespace
}  // namespace emax
