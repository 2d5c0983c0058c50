#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/decimate/editable_mesh.h"
#include "host/geometry/bounds.h"
#include "host/geometry/box_pairs.h"

namespace emax {

// A tree of boxes over the triangles of a mesh that is edited, four children to a node. The last
// rebuild decides its shape: a slot that changes keeps its leaf, and the boxes above it are
// refitted. A collapse leaves its triangles where they were, so the boxes stay tight until many
// triangles are gone. The boxes are in binary32 about the middle of the mesh, rounded outwards. The
// results of searches are exact.
class SlotTree {
 public:
  explicit SlotTree(const EditableMesh& mesh) { rebuild(mesh); }

  // O(n log n). Free slots have empty boxes.
  void rebuild(const EditableMesh& mesh);
  // Whether the mesh has changed so much since the last rebuild that a new tree would be better.
  bool outgrown(const EditableMesh& mesh) const;

  // Call this after the slot changed. O(depth) at most.
  void update(const EditableMesh& mesh, std::uint32_t slot);

  // A box in the tree's numbers. It contains the box that it was rounded from.
  struct Box {
    std::array<float, 3> lower, upper;
    bool operator==(const Box&) const = default;
  };
  Box rounded(const Bounds& box) const;

  // Calls visit(slot, its box) for every triangle whose box overlaps the given one (touching
  // counts), until visit returns false. The order depends on the edits alone. Returns whether visit
  // returned true for all.
  template <class Visit>
  bool for_each_overlap(const Box& box, const Visit& visit) const;

  struct Nearest {
    std::uint32_t slot = kNoIndex;  // the lowest of equally near ones
    double squared_distance = 0;
  };
  // The nearest of the triangles closer than the bound; kNoIndex if there is none. A `hint`, a
  // triangle likely to be near, makes the search shorter.
  Nearest nearest(const EditableMesh& mesh, const Point& p, double squared_bound,
                  std::uint32_t hint = kNoIndex) const;

 private:
  static constexpr unsigned kPlaces = 4;
  using Lanes = Eigen::Array4f;  // one for each place
  static constexpr std::uint32_t kLeaf = 1u << 31;
  static constexpr std::size_t kDeepest = 40;
  static constexpr std::size_t kStack = kPlaces * (kDeepest + 1);

  struct alignas(64) Node {
    std::array<std::array<float, kPlaces>, 3> lower, upper;  // for each axis, of each place
    std::array<std::uint32_t, kPlaces> child;  // a node, a slot with kLeaf, or kNoIndex
    std::uint32_t parent = kNoIndex;           // kPlaces * node + place
  };

  Box box_of(const Node& node) const;
  Box box_of(const Node& node, std::size_t place) const;
  void put(std::uint32_t place, std::uint32_t child, const Box& box);
  std::uint32_t add_node(std::uint32_t parent);
  struct Item {
    std::uint32_t slot;
    Box box;
  };
  void build(std::uint32_t node, std::span<Item> items);
  void insert(std::uint32_t slot, const Box& box);
  void refit(std::uint32_t node);
  static Lanes gap(const Node& node, const Box& box, std::size_t axis);
  static unsigned overlapping(const Node& node, const Box& box);  // one bit for each place

  std::vector<Node> nodes_;             // the root first
  std::vector<std::uint32_t> leaf_of_;  // of each slot, kPlaces * node + place
  Point origin_ = Point::Zero();
  double scale_ = 1;  // a power of two
  std::size_t triangles_at_rebuild_ = 0, inserted_ = 0, deepest_ = 0;
};

template <class Visit>
bool SlotTree::for_each_overlap(const Box& box, const Visit& visit) const {
  std::array<std::uint32_t, kStack> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    const unsigned places = overlapping(node, box);
    for (unsigned i = 0; i < kPlaces; ++i) {
      if ((places >> i & 1) == 0) continue;
      const std::uint32_t child = node.child[i];
      if ((child & kLeaf) == 0) {
        stack[depth++] = child;
      } else if (!visit(child & ~kLeaf, box_of(node, i))) {
        return false;
      }
    }
  }
  return true;
}

inline bool overlap(const SlotTree::Box& a, const SlotTree::Box& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.lower[i] > b.upper[i] || b.lower[i] > a.upper[i]) return false;
  }
  return true;
}

// Squared distance from a point to a triangle of any shape, in plain binary64.
double squared_distance(const Point& p, const std::array<Point, 3>& corners);

}  // namespace emax
