#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "host/files/mesh_parts.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/tiles/mesh_stars.h"

namespace emax {

// What is known of a mesh that is never in memory as a whole.
struct PartwiseCheck {
  MeshValidity validity;
  MeshTopology topology;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;  // as read_mesh() counts them
};

// The faults and the topology of a mesh in parts: the counts that check_mesh() and topology_of()
// give of the whole. Reads the mesh twice. Nothing that grows with the mesh stays in memory, except
// the triangles at a single vertex: 16 bytes each, 40 where positions stand for vertices. In files
// without a name 90 to 150 bytes a triangle. The same for any number of threads and any memory.
// O(n log n) time for the meshes of surfaces. Throws Error where the file cannot be read or was
// changed meanwhile, or where the temporary files have no room; Interrupted.
// `memory`: bytes.
PartwiseCheck check_in_parts(const MeshParts& mesh, std::uint64_t memory, std::size_t threads,
                             const std::function<bool()>& interrupted = nullptr);

// The topology and the size alone. Reads the mesh once.
MeshConnectivity connectivity_in_parts(const MeshParts& mesh, std::uint64_t memory,
                                       const std::function<bool()>& interrupted);

}  // namespace emax
