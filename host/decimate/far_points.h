#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/decimate/back_bound.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

struct FarPoints {
  TriangleMesh mesh;
  std::size_t inserted = 0;
  std::vector<std::uint32_t> left_out;  // in order: still farther than `far`
};

// Makes every point of the cloud that is farther than `far` from the mesh one of its vertices: an
// edge of the boundary near it gets a triangle, or a triangle or edge is split there. The mesh
// stays manifold and free of self-intersections and slivers, and no other point comes to be farther
// than `far`; where that cannot be had the point is left out. `mesh` is as manifold_part() gives
// it. What is added keeps `back`, where there is one. O(log n) for a point and for an insertion.
FarPoints insert_far_points(const TriangleMesh& mesh, std::span<const Point> cloud, double far,
                            const std::function<bool()>& interrupted = nullptr,
                            const BackBound* back = nullptr);

// The same on a state, whose limit is no less than `far`; the mesh is left in it.
class DecimationState;
FarPoints insert_far_points(DecimationState& state, double far,
                            const std::function<bool()>& interrupted = nullptr);

// The mesh with pieces of the reference beside those of `points` that are farther than `far` from
// it, but not from the reference: components of one triangle each, which touch nothing. For points
// that insert_far_points() leaves out, where the surface folds or ends. Points that are nearly
// `far` from the reference too are left out. O(log n) a point.
TriangleMesh cover_far_points(TriangleMesh mesh, std::span<const Point> cloud,
                              std::span<const std::uint32_t> points, const BackBound& back,
                              double far);

}  // namespace emax
