#pragma once

#include <cstdint>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Whether two triangles of a mesh meet outside the vertex or edge that they share by index;
// touching counts. Neither triangle is degenerate. Exact. Equal corners of different index are not
// shared; three shared corners are an overlap.
bool intersect_beyond_shared(const MeshView& mesh, std::size_t first, std::size_t second);

}  // namespace emax
