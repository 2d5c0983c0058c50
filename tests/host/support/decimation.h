#pragma once

#include <algorithm>
#include <limits>

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/slot_tree.h"
#include "host/geometry/triangle_mesh.h"

namespace emax::test {

inline DecimationSettings with(
    double epsilon, DecimationSettings::Effort effort = DecimationSettings::Effort::kRelax) {
  DecimationSettings settings;
  settings.epsilon = epsilon;
  settings.effort = effort;
  return settings;
}

// The squared distance from p to the surface, by every triangle, as a share of the limit squared.
inline double share_of(const Point& p, const TriangleMesh& surface, double limit) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    least = std::min(least, squared_distance(p, surface.view().corners(t)));
  }
  return least / (limit * limit);
}

}  // namespace emax::test
