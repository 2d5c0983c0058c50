#include "host/reconstruct/orient_normals.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "host/geometry/disjoint_sets.h"

namespace emax {
namespace {

struct Edge {
  float weight;
  std::uint32_t a, b;
  auto key() const { return std::tie(weight, a, b); }
};

// Where a part's orientation starts, and the sign that turns its normal outward.
struct Root {
  std::uint32_t point = 0;
  float sign = 1;
};

Root outward_root(std::span<const Eigen::Vector3f> positions,
                  std::span<const Eigen::Vector3f> normals,
                  std::span<const std::uint32_t> members) {
  Root best;
  float best_fit = -1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {1.0f, -1.0f}) {
      const auto extreme =
          *std::max_element(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
            return side * positions[a][axis] < side * positions[b][axis];
          });
      const float along = side * normals[extreme][axis];
      if (std::abs(along) > best_fit) {
        best_fit = std::abs(along);
        best = {extreme, along < 0 ? -1.0f : 1.0f};
      }
    }
  }
  return best;
}

}  // namespace

std::vector<std::uint32_t> orient_normals(std::span<const Eigen::Vector3f> positions,
                                          std::span<const std::uint32_t> neighbours, std::size_t k,
                                          std::span<Eigen::Vector3f> normals) {
  const std::size_t n = positions.size();
  std::vector<Edge> edges;
  edges.reserve(n * k);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (const std::uint32_t j : neighbours.subspan(i * k, k)) {
      if (j == i) continue;
      edges.push_back({1 - std::abs(normals[i].dot(normals[j])), std::min(i, j), std::max(i, j)});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& x, const Edge& y) { return x.key() < y.key(); });
  DisjointSets parts(n);
  std::vector<std::vector<std::uint32_t>> tree(n);
  for (const Edge& edge : edges) {
    if (!parts.join(edge.a, edge.b)) continue;
    tree[edge.a].push_back(edge.b);
    tree[edge.b].push_back(edge.a);
  }

  std::vector<std::vector<std::uint32_t>> members;
  std::vector<std::uint32_t> part(n), part_of_root(n, ~0u);
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t& of_root = part_of_root[parts.root(i)];
    if (of_root == ~0u) {
      of_root = static_cast<std::uint32_t>(members.size());
      members.emplace_back();
    }
    members[of_root].push_back(i);
    part[i] = of_root;
  }
  std::vector<std::uint32_t> stack;
  std::vector<bool> seen(n, false);
  for (const auto& points : members) {
    const Root root = outward_root(positions, normals, points);
    normals[root.point] *= root.sign;
    seen[root.point] = true;
    stack.push_back(root.point);
    while (!stack.empty()) {
      const std::uint32_t at = stack.back();
      stack.pop_back();
      for (const std::uint32_t next : tree[at]) {
        if (seen[next]) continue;
        seen[next] = true;
        if (normals[at].dot(normals[next]) < 0) normals[next] = -normals[next];
        stack.push_back(next);
      }
    }
  }
  return part;
}

}  // namespace emax
