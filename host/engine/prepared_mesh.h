#pragma once

#include <memory>
#include <vector>

#include "host/engine/engine_target.h"
#include "host/engine/mesh_leaves.h"

namespace emax {

// The form of a mesh that the engine reads: records along a Morton curve and a tree of boxes over
// them with kTreeWidth children a node. The tree is implicit: only boxes are stored. It is made
// anew for every mesh, so it is made fast: O(n), 114 bytes a triangle. The bits are the same with
// any number of threads.
class PreparedMesh {
 public:
  // Throws Error for no triangles, and as MeshLeaves does.
  PreparedMesh(MeshView mesh, const Normalization& normalization,
               const EngineTarget& target = engine_targets().front(), std::size_t threads = 1);

  // In the order of the leaves; a record's tag holds the triangle's index in the mesh.
  std::span<const TriangleRecord<float>> records() const { return leaves_->records(); }
  TreeView tree() const { return {records(), leaves_->reach(), levels_}; }
  const std::shared_ptr<const MeshLeaves>& leaves() const { return leaves_; }
  std::size_t memory_bytes() const;

 private:
  std::unique_ptr<BoxBlock[]> blocks_;
  std::vector<std::span<const BoxBlock>> levels_;
  std::shared_ptr<const MeshLeaves> leaves_;
};

}  // namespace emax
