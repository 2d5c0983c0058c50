#include "sw_model/model/normalization.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "sw_model/base/flush_mode.h"

namespace emax {

Normalization normalization_of(std::span<const Point> cloud) {
  require_no_flush("normalising");
  if (cloud.empty()) throw std::invalid_argument("an empty cloud has no bounding box");
  Eigen::AlignedBox3d box;
  for (const Point& p : cloud) {
    if (!p.allFinite())
      throw std::invalid_argument("the cloud has a coordinate that is not finite");
    box.extend(p);
  }
  return normalization_of_box(box.min(), box.max());
}

Normalization normalization_of_box(const Point& lower, const Point& upper) {
  require_no_flush("normalising");
  Normalization normalization;
  normalization.origin = lower + (upper - lower) / 2;
  const double half_extent = (upper - lower).maxCoeff() / 2;
  if (half_extent > 0) {
    // frexp gives half_extent = m 2^e with m in [1/2, 1); m = 1/2 exactly belongs to the upper end.
    int exponent = 0;
    if (std::frexp(half_extent, &exponent) == 0.5) --exponent;
    normalization.scale = std::ldexp(1.0, -exponent);
  }
  return normalization;
}

std::vector<Vector3<float>> normalized_points(std::span<const Point> cloud,
                                              const Normalization& normalization) {
  require_no_flush("normalising");
  std::vector<Vector3<float>> points;
  points.reserve(cloud.size());
  for (const Point& p : cloud) {
    const Eigen::Vector3f rounded = normalization.apply(p).cast<float>();
    points.push_back({rounded.x(), rounded.y(), rounded.z()});
  }
  return points;
}

}  // namespace emax
