#pragma once

#include <cstdint>
#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Mends a fan of triangles around a polygon's first corner. Where a triangle of the fan faces
// against the polygon, the polygon is not convex and its fan folds over itself. Such a fan is
// replaced by a triangulation of the polygon by cutting ears (Meisters 1975) in the projection
// along the polygon's normal by Newell; the ear with the shortest third side is cut first. A
// polygon that crosses itself in the projection, or has no area, keeps its fan. `fan` has two
// triangles fewer than the polygon has corners. O(n^3) at worst.
void triangulate(std::span<Triangle> fan, std::span<const Point> vertices);

}  // namespace emax
