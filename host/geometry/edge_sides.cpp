#include "host/geometry/edge_sides.h"

#include <algorithm>

namespace emax {

// Calls visit(lower vertex, side).
template <class Visit>
void EdgeSides::for_each_side(const Visit& visit) const {
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Triangle& triangle = mesh_.triangles[t];
    if (repeats_index(triangle)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const bool ascends = triangle[i] < triangle[j];
      const std::size_t lower = ascends ? i : j;
      const std::size_t upper = ascends ? j : i;
      visit(triangle[lower], EdgeSide{triangle[upper], ascends, 3 * t + lower, 3 * t + upper});
    }
  }
}

std::vector<std::uint32_t> EdgeSides::counts_of_lower_vertices() const {
  std::vector<std::uint32_t> counts(mesh_.vertices.size());
  for_each_side([&counts](std::uint32_t lower, const EdgeSide&) { ++counts[lower]; });
  return counts;
}

std::size_t EdgeSides::sides_from(std::size_t first, const std::vector<std::uint32_t>& counts,
                                  std::vector<EdgeSide>& held) const {
  std::vector<std::size_t> begin_of = {0};  // where the sides of each lower vertex begin
  std::size_t last = first;
  while (last < counts.size() && (last == first || begin_of.back() + counts[last] <= most_held_)) {
    begin_of.push_back(begin_of.back() + counts[last++]);
  }
  held.resize(begin_of.back());
  std::vector<std::size_t> next(begin_of.begin(), begin_of.end() - 1);
  for_each_side([&](std::uint32_t lower, const EdgeSide& side) {
    if (lower >= first && lower < last) held[next[lower - first]++] = side;
  });
  for (std::size_t v = 0; v + 1 < begin_of.size(); ++v) {
    const auto at = [&](std::size_t i) {
      return held.begin() + static_cast<std::ptrdiff_t>(begin_of[i]);
    };
    std::stable_sort(at(v), at(v + 1),
                     [](const EdgeSide& a, const EdgeSide& b) { return a.upper < b.upper; });
  }
  return last;
}

}  // namespace emax
