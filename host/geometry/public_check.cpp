#include <emax/check.h>

#include "host/geometry/mesh_validity.h"
#include "sw_model/base/public_arguments.h"

namespace emax {
inline namespace v1 {

SurfaceCheck check_surface(SurfaceSpan mesh) {
  const MeshValidity found = check_mesh(checked_surface(mesh, "mesh").view());
  SurfaceCheck check;
  check.non_manifold_edges = found.non_manifold_edges;
  check.non_manifold_vertices = found.non_manifold_vertices;
  check.inconsistent_edges = found.inconsistent_edges;
  check.degenerate_triangles = found.degenerate_triangles;
  check.self_intersections = found.self_intersections;
  check.boundary_edges = found.boundary_edges;
  check.components = found.components;
  return check;
}

}  // namespace v1
}  // namespace emax
