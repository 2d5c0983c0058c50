#include "host/tiles/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "host/geometry/box_pairs.h"

namespace emax {
namespace {

constexpr std::uint32_t kLeafSize = 16;

}  // namespace

BoxTree::BoxTree(std::uint32_t count, BoxOf box_of) : box_of_(std::move(box_of)), order_(count) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (count == 0) return;
  nodes_.push_back({{Point::Zero(), Point::Zero()}, 0, count, 0});
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) build(node);
}

// Splits the node at the median of its boxes' middles, along the longest side of these.
void BoxTree::build(std::uint32_t node) {
  const auto [begin, end] = std::pair{nodes_[node].begin, nodes_[node].end};
  Bounds box = box_of_(order_[begin]);
  Bounds middles{box.midpoint(), box.midpoint()};
  for (std::uint32_t i = begin; i < end; ++i) {
    const Bounds other = box_of_(order_[i]);
    box = joined(box, other);
    middles = joined(middles, {other.midpoint(), other.midpoint()});
  }
  nodes_[node].box = box;
  if (end - begin <= kLeafSize) return;
  Eigen::Index axis;
  (middles.upper - middles.lower).maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  const auto at = [this](std::uint32_t i) {
    return order_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(begin), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const double x = box_of_(a).midpoint()[axis], y = box_of_(b).midpoint()[axis];
    return x != y ? x < y : a < b;
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].children = children;
  nodes_.push_back({box, begin, half, 0});
  nodes_.push_back({box, half, end, 0});
}

void BoxTree::for_each(const Bounds& box, const std::function<void(std::uint32_t)>& visit) const {
  if (nodes_.empty()) return;
  std::vector<std::uint32_t> open = {0};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (!overlap(node.box, box)) continue;
    if (node.children != 0) {
      open.push_back(node.children + 1);
      open.push_back(node.children);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (overlap(box_of_(order_[i]), box)) visit(order_[i]);
    }
  }
}

}  // namespace emax
