#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// The points' indices along a Morton curve through their bounding box. Points that are near in
// space are then mostly near in memory. Points in the same cell keep their order. O(n log n).
std::vector<std::uint32_t> spatial_order(std::span<const Point> points);

// The mesh with its used vertices along the curve. Each triangle is turned so that its lowest
// vertex comes first, and the triangles are sorted.
TriangleMesh spatially_ordered(const TriangleMesh& mesh);

}  // namespace emax
