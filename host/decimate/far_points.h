#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/decimate/decimation_state.h"
#include "host/decimate/joining_distance.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

struct FarPoints {
  TriangleMesh mesh;
  std::size_t inserted = 0;
  std::vector<std::uint32_t> left_out;  // ascending; points that are still as far
};

// Makes the points of the state's cloud that `far` names vertices of its mesh: either an edge of
// the boundary near a point gets a triangle, or a triangle or edge is split there. The mesh stays
// manifold, and free of self-intersections and slivers where it was, and no other point becomes
// farther than far.with_others or, if it is so already, than far.alone. A point for which this is
// not possible is left out. The limit of the state must be at least far.alone. The mesh is left in
// the state. O(log n) for a point and for an insertion, O(n log n) where there is a far point.
FarPoints insert_far_points(DecimationState& state, const JoiningDistance& far,
                            const std::function<bool()>& interrupted = nullptr);

}  // namespace emax
