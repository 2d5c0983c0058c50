#pragma once

#include <cstdint>
#include <vector>

#include "host/decimate/editable_mesh.h"
#include "host/geometry/bounds.h"
#include "host/geometry/box_pairs.h"

namespace emax {

inline Bounds joined(const Bounds& a, const Bounds& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

// A binary tree of boxes over the triangles of a mesh that is edited. Its shape is that of the last
// rebuild; a slot that changes keeps its leaf, and the boxes above it are refitted. A collapse
// leaves its triangles where they were, so the boxes stay tight until many are gone.
class SlotTree {
 public:
  explicit SlotTree(const EditableMesh& mesh) { rebuild(mesh); }

  // O(n log n). Slots that are free have empty boxes.
  void rebuild(const EditableMesh& mesh);
  std::size_t added() const { return added_.size(); }  // since then
  std::size_t triangles_at_rebuild() const { return triangles_at_rebuild_; }

  // The slot changed: O(depth) at most. Slots added since the last rebuild are searched one by one.
  void update(const EditableMesh& mesh, std::uint32_t slot);

  // Calls visit(slot, its box) for every triangle whose box overlaps `box` (touching counts), in an
  // order that depends on the edits alone, until it returns false; returns whether it never did.
  template <class Visit>
  bool for_each_overlap(const Bounds& box, const Visit& visit) const;

  struct Nearest {
    std::uint32_t slot = kNoIndex;  // the lowest of equally near ones
    double squared_distance = 0;
  };
  // Among the triangles closer than the bound; kNoIndex when there is none. With a `hint`, a
  // triangle likely to be near, the search is shorter.
  Nearest nearest(const EditableMesh& mesh, const Point& p, double squared_bound,
                  std::uint32_t hint = kNoIndex) const;

 private:
  struct Node {
    Bounds box;
    std::uint32_t left = kNoIndex,
                  right = kNoIndex;  // the leaf's slot in `left` where right is kNoIndex
    std::uint32_t parent = kNoIndex;
  };

  std::uint32_t build(std::vector<std::uint32_t>& slots, std::size_t begin, std::size_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;  // of each slot
  std::vector<std::uint32_t> added_;    // slots without a leaf
  std::vector<Bounds> boxes_;           // of each slot
  std::size_t triangles_at_rebuild_ = 0;
};

template <class Visit>
bool SlotTree::for_each_overlap(const Bounds& box, const Visit& visit) const {
  for (const std::uint32_t slot : added_) {
    if (overlap(boxes_[slot], box) && !visit(slot, boxes_[slot])) return false;
  }
  if (nodes_.empty()) return true;
  std::uint32_t stack[128];
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!overlap(node.box, box)) continue;
    if (node.right == kNoIndex) {
      if (!visit(node.left, node.box)) return false;
      continue;
    }
    stack[depth++] = node.right;
    stack[depth++] = node.left;
  }
  return true;
}

// Squared distance from a point to a triangle of any shape, in plain binary64.
double squared_distance(const Point& p, const std::array<Point, 3>& corners);

}  // namespace emax
