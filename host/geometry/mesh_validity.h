#pragma once

#include <cstddef>

#include "sw_model/base/mesh_view.h"

namespace emax {

// What is wrong with a mesh, in counts. Edges and vertices are told apart by index, not position.
// Triangles with a repeated index count as degenerate and nowhere else; those of distinct corners
// but no area take part in the topology and not in the intersections.
struct MeshValidity {
  std::size_t boundary_edges = 0;         // of one triangle
  std::size_t non_manifold_edges = 0;     // of more than two
  std::size_t non_manifold_vertices = 0;  // whose triangles are more than one fan joined by edges
  std::size_t inconsistent_edges = 0;  // of two triangles that run through it in the same direction
  std::size_t degenerate_triangles = 0;  // a repeated index or exactly no area
  std::size_t self_intersections = 0;    // pairs of triangles that meet beyond what they share
  std::size_t self_intersecting_triangles = 0;  // in at least one such pair
  std::size_t components = 0;                   // of triangles joined by edges

  bool operator==(const MeshValidity&) const = default;

  // Boundaries are allowed, components as many as there are.
  bool valid() const {
    return non_manifold_edges == 0 && non_manifold_vertices == 0 && inconsistent_edges == 0 &&
           degenerate_triangles == 0 && self_intersections == 0;
  }
};

// Exact: decided by exact_predicates.h, touching counts as an intersection. Coordinates are finite.
// O(n log n) for the meshes of surfaces.
MeshValidity check_mesh(const MeshView& mesh);

}  // namespace emax
