#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

namespace emax {

using Point = Eigen::Vector3d;  // in the unit of the file it was read from, or normalised
using Triangle = std::array<std::uint32_t, 3>;  // 0-based vertex indices, in file order

// Triangles over vertices that someone else owns. Every index is < vertices.size().
struct MeshView {
  std::span<const Point> vertices;
  std::span<const Triangle> triangles;

  std::array<Point, 3> corners(std::size_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

}  // namespace emax
