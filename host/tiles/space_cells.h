#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "host/geometry/bounds.h"

namespace emax {

// Space cut by planes into cells that hold about as many boxes each, from a sample of the boxes.
// A box is in every cell that it reaches, so that two boxes that overlap are both in the cell of
// any point that both contain.
class SpaceCells {
 public:
  // Holds the points from `lower` to before `upper`.
  struct Region {
    Point lower = Point::Constant(-std::numeric_limits<double>::infinity());
    Point upper = Point::Constant(std::numeric_limits<double>::infinity());

    bool holds(const Point& p) const {
      return (p.array() >= lower.array()).all() && (p.array() < upper.array()).all();
    }
  };

  // Every box of the sample stands for `weight` boxes. Cells are cut in two while they hold more
  // than `most`, unless every plane has a greater share of the boxes than `on_both` on both of its
  // sides, or four fifths on one.
  SpaceCells(std::vector<Bounds> sample, double weight, double most, const Region& space,
             double on_both = 0.25);

  const std::vector<Region>& cells() const { return cells_; }

  // Calls visit(cell) for all that the box reaches; with `lower_only` for that of its lower corner.
  template <class Visit>
  void for_each_reached(const Bounds& box, bool lower_only, const Visit& visit) const {
    visit_from(0, box, lower_only, visit);
  }

 private:
  struct Node {
    int axis = -1;                      // -1: a cell
    double plane = 0;                   // of the second child
    std::size_t first = 0, second = 0;  // children; the cell
  };

  // Returns the node.
  std::size_t cut(std::vector<Bounds> sample, const Region& region);

  template <class Visit>
  void visit_from(std::size_t node, const Bounds& box, bool lower_only, const Visit& visit) const {
    const Node& n = nodes_[node];
    if (n.axis < 0) {
      visit(n.first);
      return;
    }
    const bool begins_before = box.lower[n.axis] < n.plane;
    if (begins_before) visit_from(n.first, box, lower_only, visit);
    if (lower_only ? !begins_before : box.upper[n.axis] >= n.plane) {
      visit_from(n.second, box, lower_only, visit);
    }
  }

  double weight_, most_, on_both_;
  std::vector<Node> nodes_;
  std::vector<Region> cells_;
};

}  // namespace emax
