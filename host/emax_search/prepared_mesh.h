#pragma once

#include <vector>

#include "host/emax_search/engine_target.h"

namespace emax {

// A mesh as the engine needs it: records along a Morton curve and over them a tree of kTreeWidth
// children a node, which is implicit: only boxes are stored. Made anew for every mesh, so it is
// made fast: O(n), 107 bytes a triangle.
class PreparedMesh {
 public:
  // Throws Error for no triangles, and as make_records does.
  PreparedMesh(MeshView mesh, const Normalization& normalization,
               const EngineTarget& target = engine_targets().front());

  // In the order of the leaves; a record's tag holds the triangle's index in the mesh.
  std::span<const TriangleRecord<float>> records() const { return records_; }
  TreeView tree() const { return {records_, reach_, levels_}; }
  std::size_t memory_bytes() const;

 private:
  std::vector<TriangleRecord<float>> records_;
  float reach_ = 0;
  std::vector<BoxBlock> blocks_;
  std::vector<std::span<const BoxBlock>> levels_;
};

}  // namespace emax
