#include "host/geometry/edge_sides.h"

#include <algorithm>
#include <numeric>

namespace emax {

EdgeSides::EdgeSides(const MeshView& mesh) : begin_of_(mesh.vertices.size() + 1, 0) {
  const auto for_each_side = [&](const auto& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& triangle = mesh.triangles[t];
      if (repeats_index(triangle)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const bool ascends = triangle[i] < triangle[j];
        const std::size_t lower = ascends ? i : j;
        const std::size_t upper = ascends ? j : i;
        visit(triangle[lower], EdgeSide{triangle[upper], ascends, 3 * t + lower, 3 * t + upper});
      }
    }
  };
  for_each_side([&](std::uint32_t lower, const EdgeSide&) { ++begin_of_[lower + 1]; });
  std::partial_sum(begin_of_.begin(), begin_of_.end(), begin_of_.begin());
  sides_.resize(begin_of_.back());
  std::vector<std::size_t> next(begin_of_.begin(), begin_of_.end() - 1);
  for_each_side([&](std::uint32_t lower, const EdgeSide& side) { sides_[next[lower]++] = side; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto at = [&](std::size_t i) {
      return sides_.begin() + static_cast<std::ptrdiff_t>(begin_of_[i]);
    };
    std::stable_sort(at(v), at(v + 1),
                     [](const EdgeSide& a, const EdgeSide& b) { return a.upper < b.upper; });
  }
}

}  // namespace emax
