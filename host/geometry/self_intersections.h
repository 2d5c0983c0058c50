#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

struct SelfIntersections {
  std::size_t pairs = 0;
  std::vector<std::uint32_t> triangles;  // in at least one pair, ascending
  std::size_t flat = 0;                  // triangles without area, which meet nothing
};

// The boxes of so many triangles are held at a time by each thread.
inline constexpr std::size_t kTrianglesOfASlab = std::size_t{1} << 20;

// The pairs of triangles that meet outside shared vertices and edges, decided by
// exact_predicates.h. Space is cut into slabs, so that memory
// does not grow with the mesh beyond five bytes a triangle; the result does not depend on them.
// Indices are in range, coordinates finite. O(n log n) for the meshes of surfaces.
SelfIntersections self_intersections(const MeshView& mesh, std::size_t threads = 1,
                                     std::size_t triangles_of_a_slab = kTrianglesOfASlab);

}  // namespace emax
