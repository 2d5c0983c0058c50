#include "host/decimate/far_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "host/geometry/mesh_validity.h"
#include "surfaces.h"
#include "sw_model/exact_distance.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

double distance(const Point& p, const TriangleMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    least = std::min(least, point_triangle_distance(p, mesh.view().corners(t)).upper);
  }
  return least;
}

// The surface with some of its triangles gone, and points around it, a few of them far away.
TEST(CoverFarPoints, ReachesWhatIsNearTheReferenceByEveryDistance) {
  constexpr std::uint64_t kSeed = 81;
  constexpr double kFar = 0.05;
  Random random(kSeed);
  const TriangleMesh reference = sheet(12, 0.3);
  const BackBound back(reference, kFar);
  std::size_t covered = 0, pieces = 0, out_of_reach = 0;
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", round " << round);
    TriangleMesh mesh = reference;
    std::erase_if(mesh.triangles, [&](const Triangle&) { return random.uniform(0, 1) < 0.3; });
    std::vector<Point> cloud;
    for (int i = 0; i < 100; ++i) {
      const auto t = static_cast<std::size_t>(random.uniform(0, 1) *
                                              static_cast<double>(reference.triangles.size()));
      const std::array<Point, 3> c = reference.view().corners(t);
      const double u = random.uniform(0, 0.5), v = random.uniform(0, 0.5);
      cloud.push_back(c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]) +
                      Point(0, 0, random.uniform(-1.5 * kFar, 1.5 * kFar)));
    }
    std::vector<std::uint32_t> all(cloud.size());
    std::iota(all.begin(), all.end(), 0u);
    const TriangleMesh whole = cover_far_points(mesh, cloud, all, back, kFar);
    EXPECT_TRUE(std::ranges::equal(mesh.triangles,
                                   std::span(whole.triangles).first(mesh.triangles.size())));
    for (const Point& p : cloud) {
      const double to_reference = distance(p, reference);
      if (to_reference > kFar) ++out_of_reach;
      if (to_reference > 0.89 * kFar) continue;
      if (distance(p, mesh) > kFar) ++covered;
      EXPECT_LE(distance(p, whole), kFar);
    }
    for (std::size_t t = mesh.triangles.size(); t < whole.triangles.size(); ++t) {
      ++pieces;
      for (const Point& corner : whole.view().corners(t)) {
        EXPECT_LT(distance(corner, reference), 1e-12);
      }
    }
    const MeshValidity before = check_mesh(mesh.view()), after = check_mesh(whole.view());
    EXPECT_EQ(after.self_intersections, before.self_intersections);
    EXPECT_EQ(after.degenerate_triangles, 0u);
    EXPECT_EQ(after.non_manifold_edges, before.non_manifold_edges);
  }
  EXPECT_GT(covered, 50u);
  EXPECT_GT(out_of_reach, 50u);
  EXPECT_GT(pieces, 20u);
  EXPECT_LE(pieces, covered);  // a piece covers what is near it
}

TEST(CoverFarPoints, LeavesAMeshAloneThatIsNearEveryPoint) {
  const TriangleMesh reference = sheet(12, 0.3);
  const BackBound back(reference, 0.05);
  std::vector<std::uint32_t> all(reference.vertices.size());
  std::iota(all.begin(), all.end(), 0u);
  const TriangleMesh same = cover_far_points(reference, reference.vertices, all, back, 0.05);
  EXPECT_EQ(same.triangles, reference.triangles);
}

}  // namespace
}  // namespace emax::test
