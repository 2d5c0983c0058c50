#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// How far each point of a cloud is from a mesh, and on which side.
struct Deviations {
  // Whether they have a sign: + outside, on the side from which triangles run counter-clockwise
  // (host/geometry/mesh_sides.h). Without one they are distances.
  bool are_signed = false;
  std::vector<double> of_points;       // in cloud order; the certified distances, with their side
  std::vector<std::uint32_t> nearest;  // of each point: the nearest triangle, the lowest of several
  // Of each triangle: the deviation that is greatest without its sign, of the kept points that are
  // nearest to this triangle; NaN where there is none.
  std::vector<float> of_triangles;
};

// `excluded`: indices of points that do not count for triangles. The deviations are signed if no
// edge of the mesh has more than two triangles, or two that run through it in one direction. The
// same bits for any number of threads. Throws as ExactMesh does. About O(points log triangles).
Deviations deviations_of(std::span<const Point> cloud, MeshView mesh,
                         std::span<const std::uint32_t> excluded, std::size_t threads);

// Of each vertex: the deviation of its triangles that is greatest without its sign; 0 where no
// point is nearest to any of them. O(triangles).
std::vector<float> deviations_of_vertices(MeshView mesh, std::span<const float> of_triangles);

// A cloud's indices along a Morton curve of 2^16 cells on each axis, so that neighbours in the
// order are neighbours in space. O(n log n).
std::vector<std::uint32_t> along_morton_curve(std::span<const Point> points);

}  // namespace emax
