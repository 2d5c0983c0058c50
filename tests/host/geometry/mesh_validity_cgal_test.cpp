// Self-intersections as CGAL counts them, on surfaces of scan-like size.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <set>

#include "host/geometry/mesh_validity.h"
#include "host/geometry/triangle_mesh.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

void expect_as_cgal_counts(const TriangleMesh& mesh, std::size_t at_least) {
  CgalMesh cgal;
  for (const Point& p : mesh.vertices) cgal.add_vertex({p[0], p[1], p[2]});
  using Vertex = CgalMesh::Vertex_index;
  for (const Triangle& t : mesh.triangles) {
    ASSERT_TRUE(cgal.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])).is_valid());
  }
  std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(cgal, std::back_inserter(pairs));
  std::set<CgalMesh::Face_index> faces;
  for (const auto& [a, b] : pairs) faces.insert({a, b});
  const MeshValidity validity = check_mesh(mesh.view());
  EXPECT_EQ(validity.self_intersections, pairs.size());
  EXPECT_EQ(validity.self_intersecting_triangles, faces.size());
  EXPECT_GE(pairs.size(), at_least);
}

TEST(MeshValidityCgal, CrumpledSphere) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Stimulus sphere = bumpy_sphere(60, 80, 0, seed);
    TriangleMesh mesh{sphere.vertices, sphere.triangles};
    Random random(seed);
    for (Point& p : mesh.vertices) p += 0.03 * static_cast<double>(seed) * random.point(-1, 1);
    expect_as_cgal_counts(mesh, 1000);
  }
}

// Vertices rounded to a coarse grid: many coplanar, touching and folded triangles.
TEST(MeshValidityCgal, SphereRoundedToAGrid) {
  const Stimulus sphere = bumpy_sphere(30, 40, 0, 1);
  TriangleMesh mesh{sphere.vertices, {}};
  for (Point& p : mesh.vertices) p = (10 * p).array().round() / 10;
  // CGAL is asked about triangles with area alone.
  for (const Triangle& t : sphere.triangles) {
    const std::vector<Triangle> one{t};
    if (check_mesh({mesh.vertices, one}).degenerate_triangles == 0) mesh.triangles.push_back(t);
  }
  EXPECT_LT(mesh.triangles.size(), sphere.triangles.size());
  expect_as_cgal_counts(mesh, 1000);
}

TEST(MeshValidityCgal, CleanSphere) {
  const Stimulus sphere = bumpy_sphere(60, 80, 0, 1);
  expect_as_cgal_counts({sphere.vertices, sphere.triangles}, 0);
  EXPECT_TRUE(check_mesh(sphere.mesh()).valid());
}

}  // namespace
}  // namespace emax::test
