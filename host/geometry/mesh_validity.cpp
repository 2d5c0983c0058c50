#include "host/geometry/mesh_validity.h"

#include <algorithm>
#include <array>
#include <vector>

#include "host/geometry/box_pairs.h"
#include "host/geometry/disjoint_sets.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/exact_predicates.h"
#include "host/geometry/triangle_pair.h"

namespace emax {
namespace {

void check_topology(const MeshView& mesh, MeshValidity& validity) {
  DisjointSets triangles(mesh.triangles.size());
  DisjointSets fans(3 * mesh.triangles.size());  // of corners at the same vertex
  EdgeSides(mesh).for_each_edge([&](std::span<const EdgeSide> sides) {
    for (const EdgeSide& side : sides.subspan(1)) {
      triangles.join(side.lower_corner / 3, sides[0].lower_corner / 3);
      fans.join(side.lower_corner, sides[0].lower_corner);
      fans.join(side.upper_corner, sides[0].upper_corner);
    }
    if (sides.size() == 1) ++validity.boundary_edges;
    if (sides.size() == 2 && sides[0].ascends == sides[1].ascends) ++validity.inconsistent_edges;
    if (sides.size() > 2) ++validity.non_manifold_edges;
  });
  std::vector<std::uint8_t> fans_at(mesh.vertices.size(), 0);  // 2 for more than one
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (repeats_index(mesh.triangles[t])) continue;
    if (triangles.root(t) == t) ++validity.components;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint8_t& seen = fans_at[mesh.triangles[t][i]];
      if (fans.root(3 * t + i) == 3 * t + i && seen < 2) ++seen;
    }
  }
  validity.non_manifold_vertices =
      static_cast<std::size_t>(std::count(fans_at.begin(), fans_at.end(), 2));
}

}  // namespace

MeshValidity check_mesh(const MeshView& mesh) {
  MeshValidity validity;
  check_topology(mesh, validity);

  std::vector<Bounds> boxes;
  std::vector<std::uint32_t> triangle_of;  // of each box
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Point, 3> corners = mesh.corners(t);
    if (repeats_index(mesh.triangles[t]) || collinear(corners[0], corners[1], corners[2])) {
      ++validity.degenerate_triangles;
      continue;
    }
    boxes.push_back(bounds_of(corners));
    triangle_of.push_back(static_cast<std::uint32_t>(t));
  }
  std::vector<std::uint8_t> intersects(mesh.triangles.size(), 0);
  BoxPairs(boxes).for_each([&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t first = triangle_of[i];
    const std::uint32_t second = triangle_of[j];
    if (!intersect_beyond_shared(mesh, first, second)) return;
    ++validity.self_intersections;
    intersects[first] = intersects[second] = 1;
  });
  validity.self_intersecting_triangles =
      static_cast<std::size_t>(std::count(intersects.begin(), intersects.end(), 1));
  return validity;
}

}  // namespace emax
