#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "host/files/mesh_parts.h"
#include "host/geometry/bounds.h"

namespace emax {

struct IntersectionCounts {
  std::size_t pairs = 0;
  std::size_t triangles = 0;  // in at least one pair
  std::size_t flat = 0;       // triangles without area, which meet nothing
  std::uint64_t read = 0;     // triangles of the mesh
};

// Of some triangles of a mesh, each of which stands for `weight` of them.
struct BoxSample {
  std::vector<Bounds> boxes;
  double weight = 1;
};

// Counts what self_intersections() counts of the same mesh in memory. Triangles are written to a
// file by cells of space, and the cells are looked at one by one. A pair of triangles is counted in
// the cell in which both of their boxes begin. A cell that is too large is cut again, or, where no
// plane divides it, taken block against block. The mesh is read once, in parts of `part_triangles`;
// takes `memory` bytes beside the part, and 88 bytes a triangle or more in a file. O(n log n) time
// for the meshes of surfaces.
IntersectionCounts intersections_in_parts(const MeshParts& mesh, std::size_t part_triangles,
                                          std::uint64_t memory, std::size_t threads,
                                          BoxSample sample, const std::function<void()>& poll);

}  // namespace emax
