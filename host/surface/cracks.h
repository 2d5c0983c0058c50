#pragma once

#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// An edge of a border loop, with the third corner of its triangle.
struct RimEdge {
  Point from, to, behind;
};

// Tells which border loops of a mesh with these vertices are cracks. The other loops are holes, and
// borders of the scanned area. A loop is a crack if it is small or narrow. It is small if no vertex
// of it is farther than d from their mean. d is the greater of `crack` and kCrackSpacings times the
// distance between vertices around the loop. It is narrow if most of its edges have an opposite
// edge ahead: one of any loop that faces it within 2 d, or the far side of the same loop within d,
// also across a sharp edge. O(n log n) in the vertices.
inline constexpr double kCrackSpacings = 3;
std::vector<bool> find_cracks(std::span<const std::vector<RimEdge>> loops,
                              std::span<const Point> vertices, double crack);

}  // namespace emax
