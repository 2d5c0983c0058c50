#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "host/files/mesh_parts.h"
#include "sw_model/base/mesh_view.h"
#include "sw_model/certify/exact_distance.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {

struct PartwiseSurfaceOptions {
  double limit = 0;          // decides as decided_distance()
  std::uint64_t memory = 0;  // bytes, beside the mesh that is in memory
  std::size_t threads = 1;
  std::function<void()> poll = nullptr;  // an exception ends the search
};

// The greatest distance of a mesh in parts from one in memory, as an interval: the greatest of all
// parts. Reads the mesh once. The witness is not given.
SurfaceDistance distance_from_parts(const MeshParts& mesh, const ExactMesh& reference,
                                    const PartwiseSurfaceOptions& options);

// The greatest distance of a mesh in memory from a reference in parts, as an interval; what is
// beyond the limit is only known to be. Space is cut into cells. Triangles of the mesh are cut in
// two until each lies in a cell or reaches little beyond it, and every cell is compared with the
// triangles of the reference that come within the limit of it. Those of all cells are in a file: 72
// bytes a triangle and cell. Roundings of the cuts are added to the interval, so that `upper` may
// be greater than the limit by these. Reads the reference twice. Throws Error where the triangles
// within the limit of a cell do not fit into the memory, or where the file was changed meanwhile.
SurfaceDistance distance_to_parts(MeshView mesh, const MeshParts& reference,
                                  const PartwiseSurfaceOptions& options);

}  // namespace emax
