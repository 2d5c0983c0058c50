#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/emax_search/packets.h"
#include "sw_model/normalization.h"

namespace emax {

// A mesh's triangles in the order of the engine's tree, along a Morton curve of their middles, with
// their corners as the frames read them. 20 bytes a triangle, 32 a vertex.
class MeshLeaves {
 public:
  // Throws Error where a triangle has a vertex that is not finite or too far, as make_records does.
  // O(n), the same with any number of threads.
  MeshLeaves(MeshView mesh, const Normalization& normalization, std::size_t threads);

  std::span<const NormalizedVertex> vertices() const { return {vertices_.get(), vertex_count_}; }
  std::span<const LeafKey> keys() const { return {keys_.get(), leaf_count_}; }
  std::span<const Triangle> corners() const { return {corners_.get(), leaf_count_}; }

  // For each leaf, one of `now` with the same corners in the same order, to the bit, or kNoLeaf.
  // O(n); of triangles that share a cell of the curve only the first few are compared.
  std::vector<std::uint32_t> carried_to(const MeshLeaves& now) const;

 private:
  bool same_corners(std::size_t leaf, const MeshLeaves& now, std::size_t other) const;

  std::size_t vertex_count_, leaf_count_;
  std::unique_ptr<NormalizedVertex[]> vertices_;
  std::unique_ptr<LeafKey[]> keys_;
  std::unique_ptr<Triangle[]> corners_;
};

}  // namespace emax
