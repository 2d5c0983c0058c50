#pragma once

#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax {

// What a scan is like, in its own unit.
struct ScanEstimate {
  // Side of the square that one point has of the surface: sqrt(area / points). Median over the
  // points of the estimate from the distance to the tenth neighbour.
  double spacing = 0;
  // Standard deviation of the points across the surface, medians over the points: of what a quadric
  // through the 25 nearest leaves, less what it cannot follow, which fewer neighbours tell. What
  // cubic terms leave grows with the third power of the radius, so that its share of the variance
  // is 9 times that of the 12 nearest; 0 where these leave less.
  double noise = 0;
};

// From at most 20,000 points, evenly spread over the indices, and their neighbours. Zeros for
// fewer than three points. O(n log n).
ScanEstimate estimate_scan(std::span<const Point> cloud);

}  // namespace emax
