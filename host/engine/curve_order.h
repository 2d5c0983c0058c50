#pragma once

#include <memory>
#include <span>

#include "host/engine/packets.h"
#include "sw_model/base/morton.h"
#include "sw_model/model/normalization.h"

namespace emax {

// A mesh's triangles along a Morton curve of their middles, and their corners as the code that
// makes frames reads them. 20 bytes a triangle, 32 a vertex.
class CurveOrder {
 public:
  // Throws Error where a triangle has a vertex that is not finite or too far, as make_records does.
  // O(n). The result is the same with any number of threads.
  CurveOrder(MeshView mesh, const Normalization& normalization, std::size_t threads);

  std::span<const NormalizedVertex> vertices() const { return {vertices_.get(), vertex_count_}; }
  std::span<const MortonKey> keys() const { return {keys_.get(), triangle_count_}; }
  std::span<const Triangle> corners() const { return {corners_.get(), triangle_count_}; }
  std::unique_ptr<MortonKey[]> take_keys() { return std::move(keys_); }

 private:
  std::size_t vertex_count_, triangle_count_;
  std::unique_ptr<NormalizedVertex[]> vertices_;
  std::unique_ptr<MortonKey[]> keys_;
  std::unique_ptr<Triangle[]> corners_;
};

}  // namespace emax
