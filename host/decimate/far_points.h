#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/decimate/decimation_state.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

struct FarPoints {
  TriangleMesh mesh;
  std::size_t inserted = 0;
  std::vector<std::uint32_t> left_out;  // ascending; points still farther than `far`
};

// Makes every point of the state's cloud that is farther than `far` from its mesh a vertex of the
// mesh: either an edge of the boundary near it gets a triangle, or a triangle or edge is split
// there. The mesh stays manifold, and free of self-intersections and slivers where it was, and no
// other point becomes farther than `far`. A point for which this is not possible is left out. The
// limit of the state must be at least `far`. The mesh is left in the state. O(log n) for a point
// and for an insertion.
FarPoints insert_far_points(DecimationState& state, double far,
                            const std::function<bool()>& interrupted = nullptr);

}  // namespace emax
