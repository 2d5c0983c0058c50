#include "host/geometry/mesh_validity.h"

#include <algorithm>
#include <vector>

#include "host/geometry/disjoint_sets.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/self_intersections.h"

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

// Several slabs for each thread.
std::size_t slab_for(const MeshView& mesh, std::size_t threads) {
  if (threads == 1) return kTrianglesOfASlab;
  constexpr std::size_t kLeast = 4096;
  return std::clamp(mesh.triangles.size() / (4 * threads), kLeast, kTrianglesOfASlab);
}

}  // namespace

MeshValidity check_mesh(const MeshView& mesh, std::size_t threads) {
  MeshValidity validity;
  check_topology(mesh, validity);
  const SelfIntersections found = self_intersections(mesh, threads, slab_for(mesh, threads));
  validity.degenerate_triangles = found.flat;
  validity.self_intersections = found.pairs;
  validity.self_intersecting_triangles = found.triangles.size();
  return validity;
}

}  // namespace emax
