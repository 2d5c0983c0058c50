#include "host/report/deviations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/geometry/triangle_mesh.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

// Every point beside every triangle.
Deviations brute_force(const Stimulus& s, const std::vector<std::uint32_t>& excluded) {
  Deviations d;
  d.of_triangles.assign(s.triangles.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::uint32_t i = 0; i < s.cloud.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = 0;
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
      const double upper = point_triangle_distance(s.cloud[i], s.mesh().corners(t)).upper;
      if (upper >= least) continue;
      least = upper;
      nearest = t;
    }
    d.of_points.push_back(least);
    d.nearest.push_back(nearest);
    if (std::ranges::find(excluded, i) != excluded.end()) continue;
    float& greatest = d.of_triangles[nearest];
    if (!(std::abs(greatest) >= static_cast<float>(least))) greatest = static_cast<float>(least);
  }
  return d;
}

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

TEST(Deviations, AreThoseOfBruteForceAtAnyNumberOfThreads) {
  const Stimulus s = bumpy_sphere(9, 12, 6000, 5);
  const std::vector<std::uint32_t> excluded = {3, 77, 5000};
  const Deviations expected = brute_force(s, excluded);
  const Deviations one = deviations_of(s.cloud, s.mesh(), excluded, 1);
  EXPECT_TRUE(one.are_signed);
  EXPECT_EQ(one.nearest, expected.nearest);
  std::size_t negative = 0;
  for (std::size_t i = 0; i < s.cloud.size(); ++i) {
    EXPECT_EQ(std::abs(one.of_points[i]), expected.of_points[i]) << i;
    negative += one.of_points[i] < 0 ? 1 : 0;
  }
  EXPECT_GT(negative, s.cloud.size() / 10);
  EXPECT_LT(negative, s.cloud.size() * 9 / 10);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    EXPECT_TRUE(same_bits(std::abs(one.of_triangles[t]), expected.of_triangles[t])) << t;
  }
  for (const std::size_t threads : {2u, 5u}) {
    const Deviations many = deviations_of(s.cloud, s.mesh(), excluded, threads);
    EXPECT_EQ(many.of_points, one.of_points);
    EXPECT_EQ(many.nearest, one.nearest);
    EXPECT_TRUE(std::ranges::equal(many.of_triangles, one.of_triangles, same_bits));
  }
}

TEST(Deviations, HaveNoSignWithoutAConsistentOrientation) {
  Stimulus s = bumpy_sphere(5, 6, 300, 6);
  std::swap(s.triangles[4][0], s.triangles[4][1]);
  const Deviations d = deviations_of(s.cloud, s.mesh(), {}, 1);
  EXPECT_FALSE(d.are_signed);
  EXPECT_TRUE(std::ranges::all_of(d.of_points, [](double x) { return x >= 0; }));
}

TEST(Deviations, OfAVertexIsTheGreatestOfItsTriangles) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Point> vertices(6, Point::Zero());
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}, {3, 4, 5}};
  EXPECT_EQ(deviations_of_vertices({vertices, triangles}, std::vector<float>{0.5F, -2, kNone}),
            (std::vector<float>{-2, 0.5F, -2, -2, 0, 0}));
}

TEST(MortonCurve, HoldsEveryPointOnceAndKeepsNeighboursTogether) {
  const Stimulus s = bumpy_sphere(4, 4, 4096, 7);
  const std::vector<std::uint32_t> order = along_morton_curve(s.cloud);
  std::vector<std::uint32_t> sorted = order;
  std::ranges::sort(sorted);
  for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
  double along = 0, in_file = 0;
  for (std::size_t k = 1; k < order.size(); ++k) {
    along += (s.cloud[order[k]] - s.cloud[order[k - 1]]).norm();
    in_file += (s.cloud[k] - s.cloud[k - 1]).norm();
  }
  EXPECT_LT(along, in_file / 5);
  EXPECT_TRUE(along_morton_curve({}).empty());
}

}  // namespace
}  // namespace emax::test
