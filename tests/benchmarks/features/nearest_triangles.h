#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax::benchmarks {

struct NearestTriangle {
  std::uint32_t triangle;
  double distance;
};

// Of each point, by CGAL's tree; the mesh has a triangle. O(n log m).
std::vector<NearestTriangle> nearest_triangles(std::span<const Point> points, MeshView mesh);

}  // namespace emax::benchmarks
