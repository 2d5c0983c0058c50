#include <algorithm>
#include <numeric>

#include "host/features/plane_detection.h"
#include "host/features/plane_grower.h"

namespace emax {

std::vector<Region> grow_planes(std::span<const Point> points, const Neighbourhoods& near,
                                const FeatureOptions& options) {
  PlaneGrower grower(points, near, options);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(near.points[i].tilt, i); });
  for (const std::uint32_t seed : order) {
    if (!grower.may_begin(seed)) continue;
    options.check();
    grower.grow_from(seed);
  }
  return std::move(grower).finished();
}

}  // namespace emax
