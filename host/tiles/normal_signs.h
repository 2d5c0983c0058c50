#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace emax {

// A point's normal as the cloud of one part makes it.
struct BorderNormal {
  std::uint64_t number;     // of the point
  std::uint32_t owner;      // the part that the point belongs to
  std::uint32_t component;  // of those whose normals this part made consistent
  Eigen::Vector3f normal;
};

// The point of a component that lies farthest along an axis, to one side.
struct ExtremePoint {
  float at = -std::numeric_limits<float>::infinity();  // along the axis, to that side
  float along = 0;                                     // its normal, likewise
  std::uint64_t number = ~std::uint64_t{0};

  // Equally far points give way to the least number.
  void take(const ExtremePoint& other);
};
using Extremes = std::array<ExtremePoint, 6>;  // x, -x, y, -y, z, -z

// What neighbours of a part have to know of it.
struct PartNormals {
  std::vector<Extremes> components;  // of its own points
  // Its own points near its border, and those of others around it, in the order of the numbers.
  std::vector<BorderNormal> own, around;
};

// The sign of every component of every part that makes all of them consistent: components that know
// the same points are compared there, and the tree of the comparisons with the most agreement or
// the most disagreement decides. Of every connected set of components the extreme point whose
// normal lies best along its axis points outward, as in orient_normals(). O(n log n).
std::vector<std::vector<float>> consistent_signs(std::span<const PartNormals> parts);

}  // namespace emax
