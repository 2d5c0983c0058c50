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
// total. The sides of a few million are held at a time, found anew by a pass over the triangles.
class EdgeSides {
 public:
  static constexpr std::size_t kMostHeld = std::size_t{1} << 22;

  // The mesh must outlive this. As many sides as `most_held`, or those of one vertex, are held.
  explicit EdgeSides(const MeshView& mesh, std::size_t most_held = kMostHeld)
      : mesh_(mesh), most_held_(most_held) {}

  // Calls visit(std::span<const EdgeSide>) with the sides of each edge, in the order of the
  // triangles. Edges come in the order of their vertices.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    const std::vector<std::uint32_t> counts = counts_of_lower_vertices();
    std::vector<EdgeSide> held;
    for (std::size_t first = 0, last; first < counts.size(); first = last) {
      last = sides_from(first, counts, held);
      for (std::span<const EdgeSide> left = held; !left.empty();) {
        std::size_t users = 1;
        while (users < left.size() && is_same_edge(left[users], left[0])) ++users;
        visit(left.first(users));
        left = left.subspan(users);
      }
    }
  }

 private:
  bool is_same_edge(const EdgeSide& a, const EdgeSide& b) const {
    return a.upper == b.upper && lower_vertex(a) == lower_vertex(b);
  }
  std::uint32_t lower_vertex(const EdgeSide& side) const {
    return mesh_.triangles[side.lower_corner / 3][side.lower_corner % 3];
  }
  std::vector<std::uint32_t> counts_of_lower_vertices() const;
  // Holds the sides of the lower vertices from `first`; the first vertex that is left for later.
  std::size_t sides_from(std::size_t first, const std::vector<std::uint32_t>& counts,
                         std::vector<EdgeSide>& held) const;
  template <class Visit>
  void for_each_side(const Visit& visit) const;

  MeshView mesh_;
  std::size_t most_held_;
};

}  // namespace emax
