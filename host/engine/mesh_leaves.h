#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/engine/engine_target.h"
#include "sw_model/base/morton.h"
#include "sw_model/model/normalization.h"

namespace emax {

// The leaves of the engine's tree: a mesh's records along a Morton curve of the triangles' middles.
// 88 bytes a triangle; 12 more a triangle, and 32 a vertex, while they are made.
class MeshLeaves {
 public:
  // Fills `blocks`, one for each kTreeWidth triangles, with the triangles' boxes. Throws Error
  // where a triangle has a vertex that is not finite or too far, as make_records does. O(n). The
  // result is the same with any number of threads.
  MeshLeaves(MeshView mesh, const Normalization& normalization, const EngineTarget& target,
             std::size_t threads, std::span<BoxBlock> blocks);

  // A record's tag holds the triangle's index in the mesh.
  std::span<const TriangleRecord<float>> records() const { return {records_.get(), count_}; }
  float reach() const { return reach_; }
  std::size_t memory_bytes() const { return count_ * (sizeof keys_[0] + sizeof records_[0]); }

  // Maps each leaf to the leaf of `now` that has the same record except for the index in its tag,
  // or to kNoLeaf where there is none. The array ends with an extra kNoLeaf. O(n): of the triangles
  // in one cell of the curve only the first few are compared.
  std::vector<std::uint32_t> carried_to(const MeshLeaves& now) const;

 private:
  std::size_t count_;
  std::unique_ptr<MortonKey[]> keys_;
  std::unique_ptr<TriangleRecord<float>[]> records_;
  float reach_ = 0;
};

}  // namespace emax
