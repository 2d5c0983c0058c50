#pragma once

#include <emax/surface.h>

#include <string_view>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Checks the arguments of public functions and copies them to the types of the libraries. Error
// names the argument.

// Throws Error for missing numbers, numbers that are not finite, and no points.
std::vector<Point> checked_points(Coordinates coordinates, std::string_view name);

struct OwnedSurface {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;
  MeshView view() const { return {vertices, triangles}; }
};
// Throws Error as above, for no triangles, and for an index out of range.
OwnedSurface checked_surface(SurfaceSpan surface, std::string_view name);

Surface as_public(MeshView mesh);

// Throws Error while this thread flushes subnormals, which would change what is proven.
void require_no_flush_of_caller();

}  // namespace emax
