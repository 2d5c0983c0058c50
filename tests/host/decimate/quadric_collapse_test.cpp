#include "host/decimate/quadric_collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

double distance(const TriangleMesh& from, const TriangleMesh& to) {
  return surface_distance(from.view(), ExactMesh(to.view()), {.relative = 0.05, .absolute = 1e-9})
      .upper;
}

std::vector<char> left_column(const TriangleMesh& mesh) {
  std::vector<char> fixed;
  for (const Point& p : mesh.vertices) fixed.push_back(p.x() == -1 ? 1 : 0);
  return fixed;
}

double longest_edge(const TriangleMesh& mesh) {
  double longest = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      longest = std::max(longest, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).norm());
    }
  }
  return longest;
}

TEST(QuadricCollapse, LeavesFewTrianglesOfAFlatSheetAndItsWholeArea) {
  const TriangleMesh flat = sheet(81, 0);
  const CollapsedMesh few = collapse_by_quadrics(flat, 1e-6);
  EXPECT_LT(few.mesh.triangles.size(), flat.triangles.size() / 40);
  EXPECT_LE(longest_edge(few.mesh), kLongestEdge * longest_edge(flat));
  EXPECT_LT(distance(flat, few.mesh), 1e-6);
  EXPECT_LT(distance(few.mesh, flat), 1e-6);
  EXPECT_TRUE(check_mesh(few.mesh.view()).valid());
}

TEST(QuadricCollapse, KeepsTheSurfaceWithinSomeDeviationsAndTheTopology) {
  for (const TriangleMesh& mesh : {bumpy(60, 90), sheet(60, 0.2), cube(16)}) {
    std::size_t last = mesh.triangles.size() - 1;
    for (const double deviation : {1e-4, 1e-3, 4e-3}) {
      const CollapsedMesh few = collapse_by_quadrics(mesh, deviation);
      EXPECT_LE(few.mesh.triangles.size(), last);
      last = few.mesh.triangles.size();
      EXPECT_LT(distance(mesh, few.mesh), 5 * deviation);
      EXPECT_LT(distance(few.mesh, mesh), 5 * deviation);
      EXPECT_TRUE(check_mesh(few.mesh.view()).valid());
      EXPECT_EQ(topology_of(few.mesh.view()), topology_of(mesh.view()));
    }
  }
}

TEST(QuadricCollapse, KeepsWhatIsFixed) {
  const TriangleMesh mesh = sheet(41, 0.05);
  const std::vector<char> fixed = left_column(mesh);
  const CollapsedMesh few = collapse_by_quadrics(mesh, 1e-3, fixed);
  ASSERT_EQ(few.vertices.size(), few.mesh.vertices.size());
  EXPECT_TRUE(std::ranges::is_sorted(few.vertices));
  std::size_t kept = 0;
  for (std::size_t v = 0; v < few.vertices.size(); ++v) {
    if (fixed[few.vertices[v]] == 0) continue;
    ++kept;
    EXPECT_EQ(few.mesh.vertices[v], mesh.vertices[few.vertices[v]]);
  }
  EXPECT_EQ(kept, 41u);
  std::size_t edges = 0;  // of the border, between fixed vertices
  for (const Triangle& t : few.mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = few.vertices[t[i]], b = few.vertices[t[(i + 1) % 3]];
      edges += fixed[a] != 0 && fixed[b] != 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(edges, 40u);
  EXPECT_LT(few.mesh.triangles.size(), mesh.triangles.size() / 3);
}

// A mean over all that a vertex stands for would lose it in a large plain.
TEST(QuadricCollapse, KeepsABumpOfAFewTriangles) {
  TriangleMesh plain = sheet(121, 0);
  for (std::uint32_t i = 59; i <= 61; ++i) {
    for (std::uint32_t j = 59; j <= 61; ++j) plain.vertices[121 * i + j].z() = 8e-3;
  }
  const CollapsedMesh few = collapse_by_quadrics(plain, 1e-3);
  EXPECT_LT(few.mesh.triangles.size(), plain.triangles.size() / 40);
  EXPECT_LT(distance(plain, few.mesh), 4e-3);
}

// With that deviation one sheet alone comes to cross where the other one is.
// Each sheet alone comes to cross where the other one is.
TEST(QuadricCollapse, LeavesNoSelfIntersections) {
  constexpr double kDeviation = 0.01;
  const TriangleMesh lower = sheet(60, 0.2);
  TriangleMesh upper = sheet(67, 0.2);
  for (Point& p : upper.vertices) p.z() += 2e-3 + 0.3 * (p.x() + 1);  // near at one side
  const TriangleMesh both = joined(lower, upper, Point::Zero());
  ASSERT_TRUE(check_mesh(both.view()).valid());
  const TriangleMesh apart = joined(collapse_by_quadrics(lower, kDeviation).mesh,
                                    collapse_by_quadrics(upper, kDeviation).mesh, Point::Zero());
  ASSERT_GT(check_mesh(apart.view()).self_intersections, 0u);
  const CollapsedMesh few = collapse_by_quadrics(both, kDeviation);
  EXPECT_TRUE(check_mesh(few.mesh.view()).valid());
  EXPECT_LT(few.mesh.triangles.size(), both.triangles.size() / 2);
}

TEST(QuadricCollapse, DoesNotRoundFarFromTheOrigin) {
  const TriangleMesh near = bumpy(40, 60);
  TriangleMesh far = near;
  for (Point& p : far.vertices) p += Point(5e6, -4e5, 100);
  const double here = static_cast<double>(collapse_by_quadrics(near, 1e-3).mesh.triangles.size());
  const double there = static_cast<double>(collapse_by_quadrics(far, 1e-3).mesh.triangles.size());
  EXPECT_NEAR(there / here, 1, 0.02);
}

TEST(QuadricCollapse, LeavesAloneWhatDeviates) {
  const TriangleMesh mesh = bumpy(30, 40);
  EXPECT_EQ(collapse_by_quadrics(mesh, 0).mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(collapse_by_quadrics({}, 1).mesh.triangles.size(), 0u);
}

}  // namespace
}  // namespace emax::test
