// What the decimator promises, as CGAL sees it, on a scan.

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include "host/decimate/certified_decimation.h"
#include "host/geometry/bounds.h"
#include "host/geometry/mesh_file.h"

namespace emax::test {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<CgalMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 cgal_point(const Point& p) { return {p[0], p[1], p[2]}; }

CgalMesh cgal_mesh(const TriangleMesh& mesh) {
  CgalMesh result;
  for (const Point& p : mesh.vertices) result.add_vertex(cgal_point(p));
  using Vertex = CgalMesh::Vertex_index;
  for (const Triangle& t : mesh.triangles) {
    // Refuses what is not manifold and consistently oriented.
    EXPECT_TRUE(result.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])).is_valid());
  }
  return result;
}

double farthest(std::span<const Point> points, const CgalMesh& mesh) {
  Tree tree(faces(mesh).begin(), faces(mesh).end(), mesh);
  tree.accelerate_distance_queries();
  double worst = 0;
  for (const Point& p : points) {
    worst = std::max(worst, CGAL::to_double(tree.squared_distance(cgal_point(p))));
  }
  return std::sqrt(worst);
}

// Corners, middles and a grid inside of every triangle.
std::vector<Point> samples(const TriangleMesh& mesh, int steps) {
  std::vector<Point> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    for (int i = 0; i <= steps; ++i) {
      for (int k = 0; i + k <= steps; ++k)
        points.push_back(a + (i * (b - a) + k * (c - a)) / steps);
    }
  }
  return points;
}

void expect_as_promised(double percent, bool two_sided, std::size_t fewer_than) {
  const TriangleMesh mesh = read_mesh(EMAX_DATA_FOLDER "/bunny00.off");
  CertifiedDecimationSettings settings;
  settings.decimation.epsilon = bounds_of(mesh.vertices).width() * percent / 100;
  settings.decimation.two_sided = two_sided;
  settings.decimation.effort = DecimationSettings::Effort::kCollapse;
  const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
  EXPECT_EQ(result.repairs, 0);
  EXPECT_LT(result.mesh.triangles.size(), fewer_than);
  const double limit = settings.decimation.epsilon * (1 + 1e-12);
  const CgalMesh cgal = cgal_mesh(result.mesh);
  EXPECT_TRUE(cgal.is_valid());
  EXPECT_FALSE(pmp::does_self_intersect(cgal));
  EXPECT_LE(farthest(mesh.vertices, cgal), limit);
  if (two_sided) {
    EXPECT_LE(farthest(samples(result.mesh, 6), cgal_mesh(mesh)), limit);
  }
}

TEST(BoundedDecimationCgal, BunnyTwoSided) { expect_as_promised(0.321, true, 1600); }

TEST(BoundedDecimationCgal, BunnyOneSided) { expect_as_promised(0.193, false, 2300); }

}  // namespace
}  // namespace emax::test
