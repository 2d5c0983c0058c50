#pragma once

#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax {

// An axis-aligned bounding box.
struct Bounds {
  Point lower;
  Point upper;

  // The width of a cloud: the longest side.
  double width() const { return (upper - lower).maxCoeff(); }
  // Halves are taken first, so that no finite box overflows.
  Point midpoint() const { return 0.5 * lower + 0.5 * upper; }
};

// `points` is not empty, its coordinates are finite. O(n).
inline Bounds bounds_of(std::span<const Point> points) {
  Bounds box{points.front(), points.front()};
  for (const Point& point : points) {
    box.lower = box.lower.cwiseMin(point);
    box.upper = box.upper.cwiseMax(point);
  }
  return box;
}

// The box around both.
inline Bounds joined(const Bounds& a, const Bounds& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

}  // namespace emax
