#pragma once

#include <cstddef>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Points spread over a mesh so that each represents an equal area. The i-th point lies in the
// triangle where (i + 1/2) / count of the area, summed in the order of the triangles, is reached. A
// low-discrepancy sequence places it in this triangle. Equal input gives equal points. The mesh
// must have triangles; a mesh without area gives its vertices. O(triangles + count).
std::vector<Point> surface_samples(MeshView mesh, std::size_t count);

}  // namespace emax
