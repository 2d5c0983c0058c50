#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "host/files/mesh_parts.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"

namespace emax {

// What the triangles of a mesh have in common by their vertices.
struct MeshConnectivity {
  MeshValidity validity;  // without degenerate triangles and intersections
  MeshTopology topology;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;  // of the file, or those of distinct position
};

// Counts what check_mesh() and topology_of() count of the same mesh in memory. The corners of all
// triangles are sorted by their vertex, so that each vertex comes with its star: the triangles at
// it. The star alone tells what becomes of its edges and fans. Which triangles are joined is
// counted by ComponentCount. The mesh is read once, in parts of `part_triangles`, each of which is
// shown to `look`. Takes `memory` bytes beside the part, and those of the greatest star; in files
// 48 bytes a triangle, 120 where positions stand for vertices, and up to 60 more where edges are
// borders. O(n log n) time.
MeshConnectivity connectivity_in_parts(const MeshParts& mesh, std::size_t part_triangles,
                                       std::uint64_t memory,
                                       const std::function<void(const MeshPart&)>& look);

}  // namespace emax
