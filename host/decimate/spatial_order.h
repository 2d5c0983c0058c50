#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// The points' indices along a Morton curve through their bounding box: what is near in space is
// mostly near in memory then. Equal cells stay in their order. O(n log n).
std::vector<std::uint32_t> spatial_order(std::span<const Point> points);

// The mesh with its used vertices along the curve and its triangles in the order of their first
// ones, each turned so that its lowest vertex leads.
TriangleMesh spatially_ordered(const TriangleMesh& mesh);

}  // namespace emax
