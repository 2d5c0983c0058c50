#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/decimate/editable_mesh.h"

namespace emax {

// Chooses edits that may be proposed before any of them is made: none changes what the proposal of
// another reads. Not for concurrent use.
class IndependentEdits {
 public:
  using Edge = std::array<std::uint32_t, 2>;
  explicit IndependentEdits(const EditableMesh& mesh) : mesh_(mesh) {}

  // Takes from `left`, in its order, each vertex that is more than two edges away from all that
  // were taken before, and leaves the others. A relocation changes the triangles at its vertex and
  // gives points to the triangles around those; it reads the triangles at the vertex and at its
  // neighbours. O(triangles around what is left).
  std::vector<std::uint32_t> take(std::vector<std::uint32_t>& left);
  // Likewise for flips: no two of the taken edges have a vertex of their triangles in common.
  // Edges that have no two triangles, and so cannot be flipped, are dropped.
  std::vector<Edge> take(std::vector<Edge>& left);

 private:
  void begin();
  bool blocked(std::uint32_t vertex) const { return blocked_[vertex] == part_; }
  void block(std::uint32_t vertex) { blocked_[vertex] = part_; }
  void block_around(std::uint32_t vertex);

  const EditableMesh& mesh_;
  std::vector<std::uint32_t> blocked_;  // the last part in which each vertex was blocked
  std::uint32_t part_ = 0;
};

}  // namespace emax
