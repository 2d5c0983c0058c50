#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "host/geometry/point_tree.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// Properties of a scan, in its own unit.
struct ScanEstimate {
  // The side of the square of surface for each point, sqrt(area / points). It is the median over
  // the points of an estimate from the distance to the tenth neighbour.
  double spacing = 0;
  // Standard deviation of the points across the surface. Quadrics are fitted through the 25 nearest
  // and through the 12 nearest points of each point; the medians of their residuals count. The
  // residual that cubic terms leave grows with the third power of the radius, so its share of the
  // variance is 9 times as great for 25 points as for 12. This share is subtracted. 0 where the
  // difference is negative.
  double noise = 0;
};

// Estimates from at most 20,000 points, evenly spread over the indices, and their neighbours. Zeros
// for fewer than three points. O(n log n).
ScanEstimate estimate_scan(std::span<const Point> cloud);
// The same with the tree of the cloud's points.
ScanEstimate estimate_scan(std::span<const Point> cloud, const PointTree& tree);

// The tolerance that suits a scan, to two digits and rounded up: half the distance of its points,
// or 6 times its noise where that is more. Nothing without a distance.
std::optional<double> suggested_tolerance(const ScanEstimate& scan);
inline constexpr std::string_view kWhySuggested =
    "half the distance of the points, between which the scan shows no surface, or 6 times the "
    "noise, whichever is more";

}  // namespace emax
