#pragma once

#include <cstdint>
#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Where a triangle of the fan around a polygon's first corner faces against the polygon, the
// polygon is not convex and its fan folds over itself. Such a fan becomes a triangulation of the
// polygon, by cutting ears (Meisters 1975), each time the one of the shortest third side, in the
// projection along the polygon's normal by Newell. A polygon that crosses itself there, or has no
// area, keeps its fan. `fan` has as many triangles as the polygon has corners, less two. O(n^3) at
// worst.
void triangulate(std::span<Triangle> fan, std::span<const Point> vertices);

}  // namespace emax
