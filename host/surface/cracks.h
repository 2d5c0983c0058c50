#pragma once

#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// An edge of a border loop, with the third corner of its triangle.
struct RimEdge {
  Point from, to, behind;
};

// Which border loops of a mesh with these vertices are cracks, the others being holes and borders
// of what was scanned. A crack is small: no vertex of it is farther from their mean than `crack`,
// or than kCrackSpacings times the distance between vertices around it, where they are sparse. Or
// it is narrow: before most of its edges, within twice that, an edge of a loop faces it, or within
// that the far side of the same loop lies, also over a sharp edge.
//
// O(n log n) in the vertices.
inline constexpr double kCrackSpacings = 3;
std::vector<bool> find_cracks(std::span<const std::vector<RimEdge>> loops,
                              std::span<const Point> vertices, double crack);

}  // namespace emax
