#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace emax {
inline namespace v1 {

// x, y, z of point 0, of point 1, ...: three finite numbers a point, in any unit. Every distance
// that goes in or comes out is in that unit.
using Coordinates = std::span<const double>;

// Three 0-based point indices a triangle, counterclockwise seen from outside.
using Indices = std::span<const std::uint32_t>;

// Triangles over points that someone else owns.
struct SurfaceSpan {
  Coordinates coordinates;
  Indices indices;
};

struct Surface {
  std::vector<double> coordinates;
  std::vector<std::uint32_t> indices;

  operator SurfaceSpan() const { return {coordinates, indices}; }
};

}  // namespace v1
}  // namespace emax
