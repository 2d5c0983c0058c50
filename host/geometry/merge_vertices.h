#pragma once

#include <vector>

#include "sw_model/mesh_view.h"

namespace emax {

// Merges vertices of exactly equal coordinates (-0 equals 0 and becomes it), drops those that no
// triangle uses, and numbers the rest in the order in which triangles first use them. Triangles
// keep their number and order; one whose corners fall together keeps its place with a repeated
// index. Coordinates are finite. O(n) expected.
void merge_equal_vertices(std::vector<Point>& vertices, std::vector<Triangle>& triangles);

}  // namespace emax
