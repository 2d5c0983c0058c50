#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/block_search/triangle_tree.h"
#include "host/engine/prepared_mesh.h"

namespace emax {

// Measures the points of a cloud piece by piece against one mesh, with the bits of the whole: all
// that a point's distance depends on beside the mesh is the normalization of its cloud. The mesh
// may be a part of one, too.
class PieceMeasurement {
 public:
  // `threads`: those that prepare the mesh. Throws as PreparedMesh does. The mesh must outlive
  // this.
  PieceMeasurement(MeshView mesh, const Normalization& normalization, bool brute_force,
                   std::size_t threads);

  // The kernel's squared distances of these points. Several threads may measure pieces at a time.
  // Throws Interrupted when `interrupted` returns true. O(n log m) in practice.
  std::vector<std::uint32_t> squared_distances(
      std::span<const Point> piece, const std::function<bool()>& interrupted = nullptr) const;
  // Lowers squared distances that the points have from other parts of a mesh (kNothingMet: none).
  void lower(std::span<const Point> piece, std::span<std::uint32_t> squared_bits,
             const std::function<bool()>& interrupted = nullptr) const;

  const Normalization& normalization() const { return normalization_; }

 private:
  Normalization normalization_;
  PreparedMesh mesh_;
  std::optional<TriangleTree> every_pair_;
};

}  // namespace emax
