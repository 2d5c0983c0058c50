#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/chain_parameters.h"

namespace emax {

// What a run fixes for the bounded decimator before its search: the same for every candidate.
struct DecimationBound {
  double epsilon = 0;       // every point stays within this of the mesh; 0: no bounded decimator
  double epsilon_back = 0;  // and all of the mesh within this of the reference; 0: one-sided
  TriangleMesh reference;   // of a two-sided bound, as reference_surface() gives it
  std::vector<std::uint32_t> outliers;  // ascending; points that count for nothing
  StageKey made_by = {};                // surface_key() of the chain that made the reference

  bool two_sided() const { return epsilon_back > 0; }
};

// The points that count; `outliers` ascending.
inline std::vector<Point> points_without(std::span<const Point> points,
                                         std::span<const std::uint32_t> outliers) {
  std::vector<Point> kept;
  kept.reserve(points.size());
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (!std::ranges::binary_search(outliers, p)) kept.push_back(points[p]);
  }
  return kept;
}

}  // namespace emax
