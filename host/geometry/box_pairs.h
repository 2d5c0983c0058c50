#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/bounds.h"

namespace emax {

inline bool overlap(const Bounds& a, const Bounds& b) {
  return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

inline std::vector<Bounds> triangle_boxes(const MeshView& mesh) {
  std::vector<Bounds> boxes;
  boxes.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    boxes.push_back(bounds_of(mesh.corners(t)));
  }
  return boxes;
}

// All pairs of overlapping (or touching) boxes, by a tree of boxes joined with itself: O(n log n)
// to build, and near O(n + pairs) to join for the triangles of a surface.
class BoxPairs {
 public:
  explicit BoxPairs(std::span<const Bounds> boxes) {
    items_.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      items_.push_back({boxes[i], static_cast<std::uint32_t>(i)});
    }
    if (items_.empty()) return;
    nodes_.resize(1);
    build(0, 0, items_.size());
  }

  // Calls visit(i, j) with i != j once for each pair, in no particular order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    if (!nodes_.empty()) join_self(0, visit);
  }

 private:
  static constexpr std::size_t kLeafSize = 4;

  struct Item {
    Bounds box;
    std::uint32_t index;
  };
  struct Node {
    Bounds box;
    std::size_t begin, end;  // of its items
    std::size_t children;    // the index of the first of two; 0 for a leaf
  };

  void build(std::size_t node, std::size_t begin, std::size_t end) {
    Bounds box = items_[begin].box;
    Bounds centres{items_[begin].box.midpoint(), items_[begin].box.midpoint()};
    for (std::size_t i = begin + 1; i < end; ++i) {
      const Point centre = items_[i].box.midpoint();
      box.lower = box.lower.cwiseMin(items_[i].box.lower);
      box.upper = box.upper.cwiseMax(items_[i].box.upper);
      centres.lower = centres.lower.cwiseMin(centre);
      centres.upper = centres.upper.cwiseMax(centre);
    }
    nodes_[node] = {box, begin, end, 0};
    if (end - begin <= kLeafSize) return;
    int axis = 0;
    (centres.upper - centres.lower).maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
      return a.box.lower[axis] + a.box.upper[axis] < b.box.lower[axis] + b.box.upper[axis];
    });
    const std::size_t children = nodes_.size();
    nodes_.resize(children + 2);
    nodes_[node].children = children;
    build(children, begin, middle);
    build(children + 1, middle, end);
  }

  template <class Visit>
  void join_self(std::size_t node, const Visit& visit) const {
    const Node& n = nodes_[node];
    if (n.children != 0) {
      join_self(n.children, visit);
      join_self(n.children + 1, visit);
      join(n.children, n.children + 1, visit);
      return;
    }
    for (std::size_t i = n.begin; i < n.end; ++i) {
      for (std::size_t j = i + 1; j < n.end; ++j) meet(items_[i], items_[j], visit);
    }
  }

  template <class Visit>
  void join(std::size_t first, std::size_t second, const Visit& visit) const {
    const Node* a = &nodes_[first];
    const Node* b = &nodes_[second];
    if (!overlap(a->box, b->box)) return;
    if (a->children == 0 && b->children == 0) {
      for (std::size_t i = a->begin; i < a->end; ++i) {
        if (!overlap(items_[i].box, b->box)) continue;
        for (std::size_t j = b->begin; j < b->end; ++j) meet(items_[i], items_[j], visit);
      }
      return;
    }
    if (a->children == 0 || (b->children != 0 && b->end - b->begin > a->end - a->begin)) {
      std::swap(a, b);
      std::swap(first, second);
    }
    join(a->children, second, visit);
    join(a->children + 1, second, visit);
  }

  template <class Visit>
  static void meet(const Item& a, const Item& b, const Visit& visit) {
    if (overlap(a.box, b.box)) visit(a.index, b.index);
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace emax
