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

// The vertex as the storage keeps it. `origin` is that of kShiftedBinary32.
Point stored(const Point& vertex, Storage storage, const Point& origin) {
  switch (storage) {
    case Storage::kBinary32:
      return rounded_to_binary32(vertex);
    case Storage::kShiftedBinary32:
      return origin + rounded_to_binary32(vertex - origin);
    default:
      return vertex;
  }
}

Point origin_for(const TriangleMesh& mesh, Storage storage) {
  return storage == Storage::kShiftedBinary32 ? storage_origin(mesh.vertices) : Point::Zero();
}

}  // namespace

Point storage_origin(std::span<const Point> vertices) {
  if (vertices.empty()) return Point::Zero();
  Point lower = vertices.front();
  for (const Point& vertex : vertices) lower = lower.cwiseMin(vertex);
  return lower + Point::Zero();  // without negative zeros
}

TriangleMesh as_stored(const TriangleMesh& mesh, Storage storage) {
  TriangleMesh result = mesh;
  const Point origin = origin_for(mesh, storage);
  for (Point& vertex : result.vertices) vertex = stored(vertex, storage, origin);
  if (storage == Storage::kBinary32 || storage == Storage::kMerged) {
    merge_equal_vertices(result.vertices, result.triangles);
  }
  return result;
}

double storage_displacement(const TriangleMesh& mesh, Storage storage) {
  double greatest = 0;
  const Point origin = origin_for(mesh, storage);
  for (const Point& vertex : mesh.vertices) {
    greatest = std::max(greatest, (stored(vertex, storage, origin) - vertex).norm());
  }
  return greatest;
}

}  // namespace emax
