#pragma once

#include <cstddef>

#include "host/decimate/plane_parts.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

struct PlaneClosing {
  double epsilon = 0;
  double farthest = 0;  // closing triangles on planes reach up to here from the mesh as it was
  std::size_t threads = 1;
};

// A surface whose holes on planes are closed.
struct ClosedOnPlanes {
  TriangleMesh mesh;
  std::size_t on_planes = 0;  // holes on a plane of the scan
  std::size_t own = 0;        // other flat holes, which epsilon cannot tell from the surface
  std::size_t wide = 0;       // holes on a plane of the scan that reach too far, and stay open
  double area = 0;            // of the triangles that close holes
};

// Closes flat holes. All vertices around a hole are within epsilon of one plane: the plane of the
// scan to which most of them belong (planes_of_vertices), or the hole's own. The border around a
// part of a plane is no hole. Where the rim folds over itself, rings of triangles around it give
// way (close_holes). No vertex is added.
//
// It is proven that each point of the closing triangles is within `farthest` of the mesh as it was,
// in a hole on its own plane within epsilon, and that what gives way is within epsilon of what
// comes in its place. Holes for which that does not hold stay open, as do those whose closing
// triangles would meet the mesh or each other. `mesh` is as cut_to_manifold() gives it; so is the
// result. The same for any number of threads. O(n log n) and what the holes take (best_patch).
ClosedOnPlanes close_on_planes(const TriangleMesh& mesh, const PlaneParts& parts,
                               const PlaneClosing& closing);

}  // namespace emax
