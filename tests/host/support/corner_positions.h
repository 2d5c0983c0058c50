#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax::test {

// The triangles of a mesh by the positions of their corners, whatever their order: equal for meshes
// that differ in the order of vertices and triangles alone.
using CornerPositions = std::array<std::array<double, 3>, 3>;
inline std::vector<CornerPositions> corner_positions(const TriangleMesh& mesh) {
  std::vector<CornerPositions> all;
  for (const Triangle& t : mesh.triangles) {
    CornerPositions corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& p = mesh.vertices[t[k]];
      corners[k] = {p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    all.push_back(corners);
  }
  std::ranges::sort(all);
  return all;
}

}  // namespace emax::test
