#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Merges vertices of exactly equal coordinates (-0 counts as 0 and becomes 0), drops vertices that
// no triangle uses, and numbers the others in the order in which triangles first use them.
// Triangles keep their number and order; a triangle whose corners were merged stays, with a
// repeated index. Coordinates are finite. O(n) expected.
void merge_equal_vertices(std::vector<Point>& vertices, std::vector<Triangle>& triangles);

// Whether any triangle uses the vertex, for each of `vertex_count` vertices. O(n).
std::vector<bool> used_vertices(std::size_t vertex_count, std::span<const Triangle> triangles);

// Drops vertices that no triangle uses; the others keep their order. O(n).
void drop_unused_vertices(std::vector<Point>& vertices, std::vector<Triangle>& triangles);

}  // namespace emax
