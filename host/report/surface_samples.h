#pragma once

#include <cstddef>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Points spread over a mesh so that each stands for an equal area: the i-th lies where (i + 1/2) /
// count of the area has been passed, in the order of the triangles, and within its triangle
// where a low-discrepancy sequence puts it. The same for equal input. A mesh without area gives
// its vertices. The mesh has triangles. O(triangles + count).
std::vector<Point> surface_samples(MeshView mesh, std::size_t count);

}  // namespace emax
