#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Indices, ascending, of points that no two are closer than `radius` and that every point of the
// cloud has within `radius`: each point is taken unless an earlier taken one is closer. The points
// are finite, radius > 0. O(n) for points of a surface.
std::vector<std::uint32_t> thinned(std::span<const Point> points, double radius);

// The radius at which `count` of the points of a surface are left, roughly. `spacing`: the side of
// the square of surface for each of `points` points.
double thinning_radius(double spacing, std::size_t points, std::size_t count);

}  // namespace emax
