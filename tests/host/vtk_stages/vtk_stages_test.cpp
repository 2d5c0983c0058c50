#include "host/vtk_stages/vtk_stages.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "host/geometry/mesh_validity.h"
#include "host/parameters/registry.h"
#include "sw_model/base/error.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

constexpr std::uint64_t kSeed = 31;

TriangleMesh closed_surface() {
  const Stimulus sphere = bumpy_sphere(24, 36, 0, kSeed);
  return {sphere.vertices, sphere.triangles};
}

// Without the triangles around one vertex.
TriangleMesh with_hole_at(TriangleMesh mesh, std::uint32_t vertex) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::find(t.begin(), t.end(), vertex) != t.end();
  });
  return mesh;
}

ParameterValues standards() { return ParameterValues(Schroeder::parameters()); }

bool less(const Point& a, const Point& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

bool vertices_are_among(const TriangleMesh& part, const TriangleMesh& whole) {
  std::vector<Point> sorted = whole.vertices;
  std::sort(sorted.begin(), sorted.end(), less);
  return std::all_of(part.vertices.begin(), part.vertices.end(), [&](const Point& p) {
    return std::binary_search(sorted.begin(), sorted.end(), p, less);
  });
}

TEST(FillHoles, ClosesAHoleWithoutNewVertices) {
  const TriangleMesh open = with_hole_at(closed_surface(), 200);
  ASSERT_EQ(check_mesh(open.view()).boundary_edges, 6u);
  const TriangleMesh filled = fill_holes(open, 0.2);
  const MeshValidity validity = check_mesh(filled.view());
  EXPECT_EQ(validity.boundary_edges, 0u);
  EXPECT_EQ(validity.inconsistent_edges, 0u);
  EXPECT_EQ(filled.triangles.size(), open.triangles.size() + 4);
  EXPECT_TRUE(vertices_are_among(filled, open));
  EXPECT_GT(signed_volume(filled), 0);
}

TEST(FillHoles, LeavesHolesLargerThanAsked) {
  const TriangleMesh open = with_hole_at(closed_surface(), 200);
  EXPECT_EQ(fill_holes(open, 0.001).triangles.size(), open.triangles.size());
}

TEST(FillHoles, OfSizeZeroChangesNothing) {
  const TriangleMesh open = with_hole_at(closed_surface(), 200);
  EXPECT_TRUE(same_bytes(fill_holes(open, 0), open));
}

TEST(FillHoles, MeasuresSizeInWidthsOfTheMesh) {
  TriangleMesh large = with_hole_at(closed_surface(), 200);
  for (Point& p : large.vertices) p *= 4096;
  EXPECT_EQ(check_mesh(fill_holes(large, 0.2).view()).boundary_edges, 0u);
  EXPECT_EQ(check_mesh(fill_holes(large, 0.001).view()).boundary_edges, 6u);
}

// Three sheets on one edge and two holes that touch in a vertex: nothing hangs or is made up.
TEST(FillHoles, SurvivesNonManifoldBoundaries) {
  TriangleMesh mesh = with_hole_at(with_hole_at(closed_surface(), 200), 202);
  mesh.vertices.push_back({0, 0, 3});
  const Triangle t = mesh.triangles[50];
  mesh.triangles.push_back({t[0], t[1], static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  const TriangleMesh filled = fill_holes(mesh, 0.2);
  EXPECT_GE(filled.triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(vertices_are_among(filled, mesh));
  EXPECT_LE(check_mesh(filled.view()).boundary_edges, check_mesh(mesh.view()).boundary_edges);
}

TEST(DecimateSchroeder, ReachesTheTarget) {
  const TriangleMesh mesh = closed_surface();
  for (const double reduction : {0.3, 0.6, 0.8}) {
    ParameterValues values = standards();
    values.set(Schroeder::kReduction, reduction);
    values.set(Schroeder::kFeatureAngle, 90);
    const TriangleMesh result = Schroeder::run(mesh, values);
    const double target = static_cast<double>(mesh.triangles.size()) * (1 - reduction);
    EXPECT_NEAR(static_cast<double>(result.triangles.size()), target, 4) << reduction;
    const MeshValidity validity = check_mesh(result.view());
    EXPECT_EQ(validity.inconsistent_edges, 0u);
    EXPECT_EQ(validity.non_manifold_edges, 0u);
    EXPECT_EQ(validity.boundary_edges, 0u);
    EXPECT_GT(signed_volume(result), 0);
  }
}

TEST(DecimateSchroeder, KeepsTheVerticesBytes) {
  const Point far(1e7, -1e7, 5e6);
  TriangleMesh mesh = closed_surface();
  for (Point& p : mesh.vertices) p = grained(p) + far;
  ParameterValues values = standards();
  // With splits new vertices are made, in places that exist.
  values.set(Schroeder::kPreserveTopology, false);
  values.set(Schroeder::kSplitting, true);
  values.set(Schroeder::kFeatureAngle, 5);
  values.set(Schroeder::kReduction, 0.9);
  const TriangleMesh result = Schroeder::run(mesh, values);
  EXPECT_LT(result.triangles.size(), mesh.triangles.size() / 4);
  EXPECT_TRUE(vertices_are_among(result, mesh));
}

TEST(DecimateSchroeder, IsTheSameFarFromTheOrigin) {
  const Point far(1e7, -1e7, 5e6);
  TriangleMesh near = closed_surface();
  for (Point& p : near.vertices) p = grained(p);
  TriangleMesh there = near;
  there.vertices = moved(near.vertices, far);
  TriangleMesh result = Schroeder::run(there, standards());
  result.vertices = moved(result.vertices, -far);
  EXPECT_TRUE(same_bytes(result, Schroeder::run(near, standards())));
}

// Every parameter reaches the filter: changing it changes some mesh.
TEST(DecimateSchroeder, HeedsEveryParameter) {
  const TriangleMesh mesh = with_hole_at(closed_surface(), 200);
  ParameterValues base = standards();
  base.set(Schroeder::kPreserveTopology, false);
  base.set(Schroeder::kSplitting, true);
  base.set(Schroeder::kFeatureAngle, 20);
  base.set(Schroeder::kReduction, 0.95);
  const TriangleMesh reference = Schroeder::run(mesh, base);
  for (const Parameter& spec : Schroeder::parameters()) {
    ParameterValues changed = base;
    double& value = changed.by_name().at(spec.name);
    value = value == spec.lower ? spec.upper : spec.lower;
    EXPECT_FALSE(same_bytes(Schroeder::run(mesh, changed), reference)) << spec.name;
  }
}

TEST(DecimateSchroeder, RepeatsItsBytes) {
  EXPECT_TRUE(same_bytes(Schroeder::run(closed_surface(), standards()),
                         Schroeder::run(closed_surface(), standards())));
}

}  // namespace
}  // namespace emax::test
