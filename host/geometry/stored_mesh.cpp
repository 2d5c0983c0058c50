#include "host/geometry/stored_mesh.h"

#include <algorithm>

#include "host/geometry/merge_vertices.h"

namespace emax {
namespace {

// The value goes through memory, because GCC 12 vectorises a pair of double(float(x)) without any
// rounding.
Point rounded_to_binary32(const Point& vertex) {
  Point stored;
  for (int k = 0; k < 3; ++k) {
    const volatile float rounded = static_cast<float>(vertex[k]);
    stored[k] = static_cast<double>(rounded);
  }
  return stored;
}

}  // namespace

TriangleMesh as_stored(const TriangleMesh& mesh, Storage storage) {
  TriangleMesh stored = mesh;
  if (storage == Storage::kBinary32) {
    for (Point& vertex : stored.vertices) vertex = rounded_to_binary32(vertex);
    merge_equal_vertices(stored.vertices, stored.triangles);
  }
  return stored;
}

double storage_displacement(const TriangleMesh& mesh, Storage storage) {
  double greatest = 0;
  if (storage == Storage::kBinary32) {
    for (const Point& vertex : mesh.vertices) {
      greatest = std::max(greatest, (rounded_to_binary32(vertex) - vertex).norm());
    }
  }
  return greatest;
}

}  // namespace emax
