#pragma once

// Meshes as CGAL sees them: an independent witness, in tests alone.

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/triangle_mesh.h"

namespace emax::test {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

inline CgalKernel::Point_3 cgal_point(const Point& p) { return {p[0], p[1], p[2]}; }

// Refuses what is not manifold and consistently oriented.
inline CgalMesh cgal_mesh(const TriangleMesh& mesh) {
  CgalMesh result;
  for (const Point& p : mesh.vertices) result.add_vertex(cgal_point(p));
  using Vertex = CgalMesh::Vertex_index;
  for (const Triangle& t : mesh.triangles) {
    EXPECT_TRUE(result.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])).is_valid());
  }
  return result;
}

// The greatest distance of a point from the mesh.
inline double farthest(std::span<const Point> points, const CgalMesh& mesh) {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<CgalMesh>;
  CGAL::AABB_tree<CGAL::AABB_traits<CgalKernel, Primitive>> tree(faces(mesh).begin(),
                                                                 faces(mesh).end(), mesh);
  tree.accelerate_distance_queries();
  double worst = 0;
  for (const Point& p : points) {
    worst = std::max(worst, CGAL::to_double(tree.squared_distance(cgal_point(p))));
  }
  return std::sqrt(worst);
}

// Vertices of no face do not count.
inline MeshTopology topology_by_cgal(CgalMesh mesh) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  const auto piece = mesh.add_property_map<CgalMesh::Face_index, std::size_t>("f:piece", 0).first;
  const auto count = [](auto n) { return static_cast<std::ptrdiff_t>(n); };
  const std::ptrdiff_t components = count(pmp::connected_components(mesh, piece));
  std::vector<CgalMesh::Halfedge_index> cycles;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  const std::ptrdiff_t loops = count(cycles.size());
  const std::ptrdiff_t used =
      std::ranges::count_if(mesh.vertices(), [&](auto v) { return !mesh.is_isolated(v); });
  const std::ptrdiff_t characteristic =
      used - count(mesh.number_of_edges()) + count(mesh.number_of_faces());
  return {static_cast<std::size_t>(components), static_cast<std::size_t>(loops),
          static_cast<std::size_t>((2 * components - loops - characteristic) / 2)};
}

}  // namespace emax::test
