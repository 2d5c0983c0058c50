#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/geometry/bounds.h"

namespace emax {

// A tree of boxes that are made again when they are looked at: four bytes a box and a node for each
// sixteen.
class BoxTree {
 public:
  using BoxOf = std::function<Bounds(std::uint32_t)>;

  // The boxes 0 to count - 1. `box_of` must outlive the tree. O(n log n).
  BoxTree(std::uint32_t count, BoxOf box_of);

  bool empty() const { return order_.empty(); }
  const Bounds& bounds() const { return nodes_.front().box; }

  // Calls visit(i) for each box that overlaps or touches this one. O(log n + found) for the
  // triangles of a surface.
  void for_each(const Bounds& box, const std::function<void(std::uint32_t)>& visit) const;

 private:
  struct Node {
    Bounds box;
    std::uint32_t begin, end;  // in order_
    std::uint32_t children;    // the first of two; 0 for a leaf
  };
  void build(std::uint32_t node);

  BoxOf box_of_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

// The box, larger by this on every side.
inline Bounds inflated(const Bounds& box, double by) {
  return {box.lower.array() - by, box.upper.array() + by};
}

}  // namespace emax
