#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

struct BoundedDecimationSettings {
  double epsilon = 0;  // every point of the cloud stays within this of the mesh
  bool two_sided = true;
  double epsilon_back = 0;  // every point of the mesh within this of the reference; 0: epsilon
  int effort = 1;           // 0: collapses alone; 1: with moves and turns; 2: deep
  std::function<bool()> interrupted = nullptr;
  bool verbose = false;
};

struct BoundedDecimation {
  TriangleMesh mesh;
  std::vector<std::uint32_t> left_out;  // points farther than epsilon from the mesh given
};

BoundedDecimation decimate_bounded(const TriangleMesh& mesh, std::span<const Point> cloud,
                                   const BoundedDecimationSettings& settings,
                                   const TriangleMesh* reference = nullptr);

}  // namespace emax
