// Decides exactly whether triangles form a surface.
//
//   #include <emax/check.h>
//
//   if (!emax::check_surface(mesh).valid()) ...
//
// Links with emax::certify. Several threads may call the function at once.
#pragma once

#include <emax/error.h>
#include <emax/surface.h>

#include <cstddef>

namespace emax {
inline namespace v1 {

// The faults of a mesh and its topology, as counts. Vertices are distinguished by index, not by
// position.
struct SurfaceCheck {
  std::size_t non_manifold_edges = 0;     // of more than two triangles
  std::size_t non_manifold_vertices = 0;  // whose triangles are more than one fan joined by edges
  std::size_t inconsistent_edges = 0;     // of two triangles that run through it the same way
  std::size_t degenerate_triangles = 0;   // a repeated index or exactly no area
  std::size_t self_intersections = 0;     // pairs that meet outside shared vertices and edges
  std::size_t boundary_edges = 0;         // of one triangle; not a fault
  std::size_t components = 0;             // of triangles joined by edges

  bool valid() const {
    return non_manifold_edges == 0 && non_manifold_vertices == 0 && inconsistent_edges == 0 &&
           degenerate_triangles == 0 && self_intersections == 0;
  }
};

// Throws Error for an argument that is not a mesh. O(n log n) for the meshes of surfaces.
EMAX_API SurfaceCheck check_surface(SurfaceSpan mesh);

}  // namespace v1
}  // namespace emax
