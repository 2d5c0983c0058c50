#include "host/surface/mesh_orientation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "host/geometry/mesh_validity.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

constexpr std::uint64_t kSeed = 20;

TriangleMesh closed_surface() {
  const Stimulus sphere = bumpy_sphere(12, 18, 0, kSeed);
  return {sphere.vertices, sphere.triangles};
}

std::vector<Eigen::Vector3f> radial_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  for (const Point& p : mesh.vertices) normals.push_back(p.normalized().cast<float>());
  return normals;
}

void turn_some(TriangleMesh& mesh, std::uint64_t seed, double share) {
  Random random(seed);
  for (Triangle& t : mesh.triangles) {
    if (random.uniform(0, 1) < share) std::swap(t[1], t[2]);
  }
}

TEST(OrientConsistently, MendsTurnedTrianglesByNormals) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  TriangleMesh mesh = closed_surface();
  turn_some(mesh, kSeed, 0.5);
  ASSERT_GT(check_mesh(mesh.view()).inconsistent_edges, 0u);
  orient_consistently(mesh, radial_normals(mesh));
  EXPECT_EQ(check_mesh(mesh.view()).inconsistent_edges, 0u);
  EXPECT_GT(signed_volume(mesh), 0);
}

TEST(OrientConsistently, FollowsNormalsThatPointInward) {
  TriangleMesh mesh = closed_surface();
  std::vector<Eigen::Vector3f> normals = radial_normals(mesh);
  for (auto& n : normals) n = -n;
  orient_consistently(mesh, normals);
  EXPECT_EQ(check_mesh(mesh.view()).inconsistent_edges, 0u);
  EXPECT_LT(signed_volume(mesh), 0);
}

TEST(OrientConsistently, KeepsTheMajoritysSideWithoutNormals) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  TriangleMesh mesh = closed_surface();
  const double volume = signed_volume(mesh);
  turn_some(mesh, kSeed, 0.2);
  ASSERT_GT(check_mesh(mesh.view()).inconsistent_edges, 0u);
  orient_consistently(mesh);
  EXPECT_EQ(check_mesh(mesh.view()).inconsistent_edges, 0u);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), volume);
}

TEST(OrientConsistently, TreatsSeparatePartsSeparately) {
  TriangleMesh mesh = closed_surface();
  const TriangleMesh second = closed_surface();
  const auto first_size = static_cast<std::uint32_t>(mesh.vertices.size());
  std::vector<Eigen::Vector3f> normals = radial_normals(mesh);
  for (const Eigen::Vector3f& n : radial_normals(second)) normals.push_back(n);
  for (const Point& p : second.vertices) mesh.vertices.push_back(p + Point(5, 0, 0));
  for (Triangle t : second.triangles) {
    mesh.triangles.push_back({t[0] + first_size, t[2] + first_size, t[1] + first_size});
  }
  orient_consistently(mesh, normals);
  EXPECT_EQ(check_mesh(mesh.view()).inconsistent_edges, 0u);
  EXPECT_NEAR(signed_volume(mesh), 2 * signed_volume(second), 1e-9);
}

// Five triangles (i, i+1, i+2) over five vertices are a Moebius strip: at least one edge stays
// inconsistent however they are turned.
TEST(OrientConsistently, LeavesOneEdgeOfAMoebiusStrip) {
  TriangleMesh mesh;
  for (int i = 0; i < 5; ++i) mesh.vertices.emplace_back(std::cos(i), std::sin(i), i % 2);
  for (std::uint32_t i = 0; i < 5; ++i) {
    mesh.triangles.push_back({i, (i + 1) % 5, (i + 2) % 5});
  }
  orient_consistently(mesh);
  EXPECT_EQ(check_mesh(mesh.view()).inconsistent_edges, 1u);
}

// Three sheets on one edge belong to no common side: each keeps its own.
TEST(OrientConsistently, DoesNotCrossNonManifoldEdges) {
  TriangleMesh mesh{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                    {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const auto before = mesh.triangles;
  orient_consistently(mesh);
  EXPECT_EQ(mesh.triangles, before);
}

// Two triangles back to back on an edge of a surface go; three on the same vertices leave one.
TEST(DropFolds, DropsPairsOnTheSameVertices) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 1, 1}},
                    {{0, 1, 2}, {1, 4, 2}, {1, 3, 2}, {2, 4, 1}, {3, 4, 5}, {4, 5, 3}, {5, 4, 3}}};
  ASSERT_GT(check_mesh(mesh.view()).non_manifold_edges, 0u);
  drop_folds(mesh);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {5, 4, 3}}));
  EXPECT_EQ(check_mesh(mesh.view()).non_manifold_edges, 0u);
}

TEST(DropUnused, DropsRepeatedVerticesAndWhatNoTriangleUses) {
  TriangleMesh mesh{{{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}, {8, 8, 8}},
                    {{0, 2, 3}, {4, 4, 0}, {2, 4, 2}}};
  drop_unused(mesh);
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

}  // namespace
}  // namespace emax::test
