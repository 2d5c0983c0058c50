#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// The nearest points of a cloud: a tree of median splits. Copies the points.
class PointTree {
 public:
  struct Neighbour {
    double squared_distance;
    std::uint32_t index;
    auto operator<=>(const Neighbour&) const = default;
  };

  // O(n log n).
  explicit PointTree(std::span<const Point> points);

  std::size_t size() const { return points_.size(); }

  // The k nearest points, or all if there are fewer, nearest first; equal distances in the order of
  // the indices, the lower first. O(k log k + log n) for points of a surface. Safe for concurrent
  // use.
  void nearest(const Point& p, std::size_t k, std::vector<Neighbour>& found) const;

 private:
  struct Node {
    double split;              // coordinate of the plane between the children
    std::uint32_t begin, end;  // places of its points
    std::uint32_t right;       // the right child (the left child follows its parent); 0 in a leaf
    int axis;
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);
  void search(std::uint32_t node, const Point& p, std::size_t k, Point beyond,
              std::vector<Neighbour>& found) const;

  std::vector<Node> nodes_;
  std::vector<Point> points_;            // in the order of the leaves
  std::vector<std::uint32_t> original_;  // the index of each in the cloud
};

}  // namespace emax
