#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hls/kernel/triangle_record.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// A triangle as the kernel reads it, but in binary64 without rounding, and beginning at its first
// corner, where a kernel record begins at the longest edge. The local search moves the first corner
// and needs its weight in a foot. Not degenerate; the tag is not used.
using LocalFrame = TriangleRecord<double>;

LocalFrame local_frame(const std::array<Point, 3>& corners);

// Points in arrays of coordinates, each with the nearest of a few triangles.
struct LocalPoints {
  std::vector<double> x, y, z;
  std::vector<double> squared;  // distance to the nearest
  std::vector<double> nearest;  // its index; a double so that it selects with the distance

  std::size_t size() const { return count; }
  Point at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void clear() { count = 0; }
  void push_back(const Point& p);

  std::size_t count = 0;  // the arrays are longer by at least a vector
};

// Sets `squared` and `nearest` for all points; of equally near triangles the first counts.
// Rounding: a few units in the last place of the extent of points and triangles around their
// frames. The bits are the same on every SIMD target.
void measure(LocalPoints& points, std::span<const LocalFrame> triangles);

// An even power of a distance, from its square.
inline double power_of(double squared, int power) {
  double result = squared;
  for (int i = 2; i < power; i += 2) result *= squared;
  return result;
}

// The nearest point of a triangle, described by its first corner.
struct Foot {
  Point residual;   // from the foot to the point
  Point direction;  // the unit vector in which the distance grows
  double weight;    // of the first corner in the foot
};
Foot foot_on(const LocalFrame& frame, const Point& p);

}  // namespace emax
