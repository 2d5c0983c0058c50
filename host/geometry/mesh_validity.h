#pragma once

#include <cstddef>

#include "sw_model/base/mesh_view.h"

namespace emax {

// The faults of a mesh, as counts. Edges and vertices are distinguished by index, not by position.
// Triangles with a repeated index count only as degenerate. Triangles of distinct corners without
// area count in the topology, but not in the intersections.
struct MeshValidity {
  std::size_t boundary_edges = 0;         // of one triangle
  std::size_t non_manifold_edges = 0;     // of more than two
  std::size_t non_manifold_vertices = 0;  // whose triangles are more than one fan joined by edges
  std::size_t inconsistent_edges = 0;  // of two triangles that run through it in the same direction
  std::size_t degenerate_triangles = 0;         // a repeated index or exactly no area
  std::size_t self_intersections = 0;           // pairs that meet outside shared vertices and edges
  std::size_t self_intersecting_triangles = 0;  // that are in at least one such pair
  std::size_t components = 0;                   // of triangles joined by edges

  bool operator==(const MeshValidity&) const = default;

  // Boundaries and any number of components are allowed.
  bool valid() const {
    return non_manifold_edges == 0 && non_manifold_vertices == 0 && inconsistent_edges == 0 &&
           degenerate_triangles == 0 && self_intersections == 0;
  }
};

// Exact: decided by exact_predicates.h. Touching counts as an intersection. Coordinates are finite.
// O(n log n) for the meshes of surfaces; 25 bytes a triangle, and some 150 MB for each thread. The
// same for any number of threads.
MeshValidity check_mesh(const MeshView& mesh, std::size_t threads = 1);

}  // namespace emax
