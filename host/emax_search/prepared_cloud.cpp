#include "host/emax_search/prepared_cloud.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace emax {
namespace {

Point widened(const Vector3<float>& p) { return {p.x, p.y, p.z}; }

}  // namespace

PreparedCloud::PreparedCloud(std::span<const Point> cloud)
    : normalization_(normalization_of(cloud)),
      points_(normalized_points(cloud, normalization_)),
      order_(points_.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  split(0, order_.size());
}

Eigen::AlignedBox3d PreparedCloud::box_of(std::size_t first, std::size_t last) const {
  Eigen::AlignedBox3d box;
  for (std::size_t i = first; i < last; ++i) box.extend(widened(points_[order_[i]]));
  return box;
}

// A kd-split at the median of the longest side. Equal coordinates are ordered by index, so the
// groups are the same with every standard library.
void PreparedCloud::split(std::size_t first, std::size_t last) {
  const Eigen::AlignedBox3d box = box_of(first, last);
  if (last - first <= kGroupPoints) {
    std::sort(order_.begin() + static_cast<std::ptrdiff_t>(first),
              order_.begin() + static_cast<std::ptrdiff_t>(last));
    groups_.push_back({std::span(order_).subspan(first, last - first), box});
    return;
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t groups = (last - first + kGroupPoints - 1) / kGroupPoints;
  const std::size_t middle = first + groups / 2 * kGroupPoints;
  const auto key = [&](std::uint32_t i) { return std::pair(widened(points_[i])[axis], i); };
  std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                   order_.begin() + static_cast<std::ptrdiff_t>(middle),
                   order_.begin() + static_cast<std::ptrdiff_t>(last),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  split(first, middle);
  split(middle, last);
}

}  // namespace emax
