#pragma once

#include <cstddef>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// An indexed triangle mesh in 64-bit coordinates.
struct TriangleMesh {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;

  MeshView view() const { return {vertices, triangles}; }
};

inline std::size_t size_in_bytes(const TriangleMesh& mesh) {
  return mesh.vertices.size() * sizeof(Point) + mesh.triangles.size() * sizeof(Triangle);
}

}  // namespace emax
