#pragma once

#include <vector>

#include "sw_model/mesh_view.h"

namespace emax {

// An indexed triangle mesh in 64-bit coordinates.
struct TriangleMesh {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;

  MeshView view() const { return {vertices, triangles}; }
};

}  // namespace emax
