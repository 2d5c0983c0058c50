#pragma once

#include <emax/surface.h>

#include <string_view>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// The arguments of public functions as the libraries take them, judged: Error names the argument.

// Throws Error where numbers are missing or not finite, or where there is no point.
std::vector<Point> checked_points(Coordinates coordinates, std::string_view name);

struct OwnedSurface {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;
  MeshView view() const { return {vertices, triangles}; }
};
// Throws Error likewise, for no triangle, and for an index out of range.
OwnedSurface checked_surface(SurfaceSpan surface, std::string_view name);

Surface as_public(MeshView mesh);

// Throws Error while this thread flushes subnormals, which would change what is proven.
void require_no_flush_of_caller();

}  // namespace emax
