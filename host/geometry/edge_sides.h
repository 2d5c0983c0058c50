#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

inline bool repeats_index(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// One side of a triangle, stored at the lower of its two vertices.
struct EdgeSide {
  std::uint32_t upper;       // the other vertex
  bool ascends;              // the triangle runs from lower to upper
  std::size_t lower_corner;  // 3 * triangle + the place of the vertex in it
  std::size_t upper_corner;
};

// The sides of all triangles, grouped by edge. Triangles with a repeated index have no sides here.
// Indices are in range. O(n log n) in the greatest number n of sides at one vertex, linear in the
// total.
class EdgeSides {
 public:
  explicit EdgeSides(const MeshView& mesh);

  // Calls visit(std::span<const EdgeSide>) with the sides of each edge, in the order of the
  // triangles. Edges come in the order of their vertices.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::size_t v = 0; v + 1 < begin_of_.size(); ++v) {
      std::span<const EdgeSide> left =
          std::span(sides_).subspan(begin_of_[v], begin_of_[v + 1] - begin_of_[v]);
      while (!left.empty()) {
        std::size_t users = 1;
        while (users < left.size() && left[users].upper == left[0].upper) ++users;
        visit(left.first(users));
        left = left.subspan(users);
      }
    }
  }

 private:
  std::vector<std::size_t> begin_of_;  // where the sides of each lower vertex begin
  std::vector<EdgeSide> sides_;        // sides at one lower vertex are sorted by the upper one
};

}  // namespace emax
