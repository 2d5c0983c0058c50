#include "host/geometry/point_tree.h"

#include <algorithm>
#include <numeric>

#include "host/geometry/bounds.h"

namespace emax {
namespace {

constexpr std::uint32_t kLeaf = 12;  // points

}  // namespace

PointTree::PointTree(std::span<const Point> points) : points_(points.begin(), points.end()) {
  original_.resize(points.size());
  std::iota(original_.begin(), original_.end(), 0u);
  if (points.empty()) return;
  nodes_.reserve(4 * points.size() / kLeaf + 1);
  build(0, static_cast<std::uint32_t>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) points_[i] = points[original_[i]];
}

// points_ keep their original order until the tree is built.
std::uint32_t PointTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({0, begin, end, 0, 0});
  if (end - begin <= kLeaf) return node;
  Bounds box{points_[original_[begin]], points_[original_[begin]]};
  for (std::uint32_t i = begin; i < end; ++i) {
    const Point& p = points_[original_[i]];
    box = joined(box, {p, p});
  }
  int axis = 0;
  (box.upper - box.lower).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(original_.begin() + begin, original_.begin() + middle, original_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b);
                   });
  const double split = points_[original_[middle]][axis];
  build(begin, middle);
  const std::uint32_t right = build(middle, end);
  nodes_[node] = {split, begin, end, right, axis};
  return node;
}

void PointTree::nearest(const Point& p, std::size_t k, std::vector<Neighbour>& found) const {
  found.clear();
  if (k > 0 && !points_.empty()) search(0, p, k, Point::Zero(), found);
  std::ranges::sort_heap(found);
}

// `found` is a heap of the nearest so far. `beyond` is how far p lies outside the node along each
// axis.
void PointTree::search(std::uint32_t at, const Point& p, std::size_t k, Point beyond,
                       std::vector<Neighbour>& found) const {
  const Node& node = nodes_[at];
  if (node.right == 0) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Neighbour neighbour{(points_[i] - p).squaredNorm(), original_[i]};
      if (found.size() == k) {
        if (!(neighbour < found.front())) continue;
        std::ranges::pop_heap(found);
        found.back() = neighbour;
      } else {
        found.push_back(neighbour);
      }
      std::ranges::push_heap(found);
    }
    return;
  }
  const double side = p[node.axis] - node.split;
  const std::uint32_t left = at + 1;
  search(side < 0 ? left : node.right, p, k, beyond, found);
  beyond[node.axis] = side;
  if (found.size() < k || beyond.squaredNorm() <= found.front().squared_distance) {
    search(side < 0 ? node.right : left, p, k, beyond, found);
  }
}

}  // namespace emax
