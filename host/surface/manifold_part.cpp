#include "host/surface/manifold_part.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "host/geometry/box_pairs.h"
#include "host/geometry/disjoint_sets.h"
#include "host/geometry/exact_predicates.h"
#include "host/geometry/merge_vertices.h"
#include "host/geometry/triangle_pair.h"
#include "host/surface/mesh_orientation.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr double kGreatestCoordinate = 1e150;

void require_usable(const TriangleMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertices[v].allFinite() &&
        mesh.vertices[v].cwiseAbs().maxCoeff() < kGreatestCoordinate) {
      continue;
    }
    throw Error("vertex " + std::to_string(v) +
                " of the mesh has a coordinate that is not finite or too large; remove it");
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v < mesh.vertices.size()) continue;
      throw Error("triangle " + std::to_string(t) + " of the mesh names vertex " +
                  std::to_string(v) + ", which does not exist; write the mesh anew");
    }
  }
}

Point normal_of(const TriangleMesh& mesh, std::uint32_t t) {
  const auto [a, b, c] = mesh.view().corners(t);
  return (b - a).cross(c - a);
}

using Flags = std::vector<std::uint8_t>;

std::size_t drop(TriangleMesh& mesh, const Flags& flags) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (flags[t] == 0) mesh.triangles[kept++] = mesh.triangles[t];
  }
  const std::size_t dropped = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  return dropped;
}

std::size_t drop_degenerate(TriangleMesh& mesh) {
  Flags flags(mesh.triangles.size(), 0);
  std::set<Triangle> seen;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle sorted = mesh.triangles[t];
    std::sort(sorted.begin(), sorted.end());
    const auto [a, b, c] = mesh.view().corners(t);
    // A normal of length 0 is of no use, even where exact arithmetic finds an area.
    const bool repeats = sorted[0] == sorted[1] || sorted[1] == sorted[2];
    flags[t] = repeats || collinear(a, b, c) ||
               !(normal_of(mesh, static_cast<std::uint32_t>(t)).squaredNorm() > 0) ||
               !seen.insert(sorted).second;
  }
  return drop(mesh, flags);
}

struct Side {
  std::uint32_t low, high, triangle;
  bool rises;
};

std::vector<Side> sides_by_edge(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = mesh.triangles[t][i], to = mesh.triangles[t][(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return std::tie(s.low, s.high, s.triangle) < std::tie(t.low, t.high, t.triangle);
  });
  return sides;
}

// Calls visit(sides) for the sides of each edge.
template <class Visit>
void for_each_edge(std::span<const Side> sides, const Visit& visit) {
  while (!sides.empty()) {
    const Side& edge = sides.front();
    std::size_t users = 1;
    while (users < sides.size() && sides[users].low == edge.low && sides[users].high == edge.high) {
      ++users;
    }
    visit(sides.first(users));
    sides = sides.subspan(users);
  }
}

std::size_t drop_at_edges(TriangleMesh& mesh) {
  Flags flags(mesh.triangles.size(), 0);
  for_each_edge(sides_by_edge(mesh), [&](std::span<const Side> sides) {
    const bool agree = sides.size() == 2 && sides[0].rises != sides[1].rises;
    if (sides.size() == 1 || agree) return;
    const Side* one = nullptr;
    const Side* other = nullptr;
    double best = -2;
    for (const Side& s : sides) {
      const Point n = normal_of(mesh, s.triangle);
      if (other == nullptr &&
          (one == nullptr || n.norm() > normal_of(mesh, one->triangle).norm())) {
        one = &s;
      }
      for (const Side& t : sides) {
        if (s.triangle >= t.triangle || s.rises == t.rises) continue;
        const double flat = n.normalized().dot(normal_of(mesh, t.triangle).normalized());
        if (flat <= best) continue;
        best = flat;
        one = &s;
        other = &t;
      }
    }
    for (const Side& s : sides) {
      if (&s != one && &s != other) flags[s.triangle] = 1;
    }
  });
  return drop(mesh, flags);
}

// The corners of triangles (3 * triangle + place) in fans. Edges at the vertex join a fan's
// corners.
class Fans {
 public:
  explicit Fans(const TriangleMesh& mesh) : mesh_(mesh), sets_(3 * mesh.triangles.size()) {}

  // Joins the corners of two triangles at the ends of the edge that they share.
  void join(const Side& s, const Side& t) {
    for (const std::uint32_t vertex : {s.low, s.high}) {
      sets_.join(corner_at(s.triangle, vertex), corner_at(t.triangle, vertex));
    }
  }
  std::size_t root(std::uint32_t corner) { return sets_.root(corner); }

 private:
  std::uint32_t corner_at(std::uint32_t t, std::uint32_t vertex) const {
    const Triangle& triangle = mesh_.triangles[t];
    return 3 * t + (triangle[0] == vertex ? 0u : triangle[1] == vertex ? 1u : 2u);
  }

  const TriangleMesh& mesh_;
  DisjointSets sets_;
};

// For each vertex, the root of its fan of the greatest area; ~0 where it has no fan.
std::vector<std::uint32_t> largest_fans(const TriangleMesh& mesh, Fans& fans) {
  const auto corners = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  std::vector<double> area(corners, 0);  // of each root
  for (std::uint32_t c = 0; c < corners; ++c) area[fans.root(c)] += normal_of(mesh, c / 3).norm();
  std::vector<std::uint32_t> best(mesh.vertices.size(), ~0u);
  for (std::uint32_t c = 0; c < corners; ++c) {
    if (fans.root(c) != c) continue;
    std::uint32_t& winner = best[mesh.triangles[c / 3][c % 3]];
    if (winner == ~0u || area[c] > area[winner]) winner = c;
  }
  return best;
}

std::size_t drop_at_vertices(TriangleMesh& mesh) {
  Fans fans(mesh);
  for_each_edge(sides_by_edge(mesh), [&](std::span<const Side> sides) {
    for (const Side& s : sides.subspan(1)) fans.join(sides[0], s);
  });
  const std::vector<std::uint32_t> best = largest_fans(mesh, fans);
  Flags flags(mesh.triangles.size(), 0);
  for (std::uint32_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
    if (best[mesh.triangles[c / 3][c % 3]] != fans.root(c)) flags[c / 3] = 1;
  }
  return drop(mesh, flags);
}

// Pairs the sides of an edge that run through it in opposite directions, beginning with the pair
// that folds least, and calls join(s, t) for each pair. Returns whether any side has no partner.
template <class Join>
bool pair_sides(const TriangleMesh& mesh, std::span<const Side> sides, const Join& join) {
  std::vector<const Side*> open;
  for (const Side& s : sides) open.push_back(&s);
  for (;;) {
    double best = -2;
    std::pair<std::size_t, std::size_t> pair;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Point n = normal_of(mesh, open[i]->triangle).normalized();
      for (std::size_t j = i + 1; j < open.size(); ++j) {
        if (open[i]->rises == open[j]->rises) continue;
        const double flat = n.dot(normal_of(mesh, open[j]->triangle).normalized());
        if (flat <= best) continue;
        best = flat;
        pair = {i, j};
      }
    }
    if (best < -1.5) return !open.empty();
    join(*open[pair.first], *open[pair.second]);
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(pair.second));
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(pair.first));
  }
}

// Splits triangles at collinear ones. Where a triangle without area has a corner on a side of a
// single other triangle, that other triangle is split at the corner, so no part of the surface is
// lost.
std::size_t split_at_collinear(TriangleMesh& mesh) {
  std::size_t split = 0;
  const std::vector<Side> sides = sides_by_edge(mesh);
  std::vector<std::uint8_t> touched(mesh.triangles.size(), 0);
  const auto is_flat = [&](std::uint32_t t) {
    const auto [a, b, c] = mesh.view().corners(t);
    return collinear(a, b, c);
  };
  const std::size_t triangles = mesh.triangles.size();
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Triangle flat = mesh.triangles[t];
    if (touched[t] != 0 || flat[0] == flat[1] || flat[1] == flat[2] || flat[2] == flat[0] ||
        !is_flat(t)) {
      continue;
    }
    // Finds its longest side, and the corner between the ends.
    std::size_t longest = 0;
    const auto length = [&](std::size_t i) {
      return (mesh.vertices[flat[(i + 1) % 3]] - mesh.vertices[flat[i]]).squaredNorm();
    };
    for (std::size_t i = 1; i < 3; ++i) longest = length(i) > length(longest) ? i : longest;
    const std::uint32_t from = flat[longest], to = flat[(longest + 1) % 3];
    const std::uint32_t middle = flat[(longest + 2) % 3];
    const std::uint32_t low = std::min(from, to), high = std::max(from, to);
    const auto first = std::lower_bound(
        sides.begin(), sides.end(), std::tie(low, high),
        [](const Side& s, const auto& edge) { return std::tie(s.low, s.high) < edge; });
    std::uint32_t other = ~0u;
    std::size_t users = 0;
    for (auto s = first; s != sides.end() && s->low == low && s->high == high; ++s, ++users) {
      if (s->triangle != t) other = s->triangle;
    }
    if (users != 2 || touched[other] != 0 || is_flat(other)) continue;
    Triangle one = mesh.triangles[other], two = one;
    for (std::size_t i = 0; i < 3; ++i) {
      if (one[i] == to) one[i] = middle;
      if (two[i] == from) two[i] = middle;
    }
    const std::array<Point, 3> c = {mesh.vertices[one[0]], mesh.vertices[one[1]],
                                    mesh.vertices[one[2]]};
    const std::array<Point, 3> d = {mesh.vertices[two[0]], mesh.vertices[two[1]],
                                    mesh.vertices[two[2]]};
    if (collinear(c[0], c[1], c[2]) || collinear(d[0], d[1], d[2])) continue;
    mesh.triangles[other] = one;
    mesh.triangles[t] = two;
    touched[other] = touched[t] = 1;
    ++split;
  }
  return split;
}

void cut_apart(CutSurface& surface) {
  TriangleMesh& mesh = surface.mesh;
  Fans fans(mesh);
  for_each_edge(sides_by_edge(mesh), [&](std::span<const Side> sides) {
    const bool parted =
        pair_sides(mesh, sides, [&](const Side& s, const Side& t) { fans.join(s, t); });
    if (sides.size() > 2 || (sides.size() == 2 && parted)) ++surface.cut_edges;
  });
  // The fan of the greatest area keeps the vertex.
  std::vector<std::uint32_t> keeper = largest_fans(mesh, fans);
  std::vector<std::uint32_t> vertex_of(3 * mesh.triangles.size(), ~0u);  // of each other root
  std::vector<std::uint8_t> cut(mesh.vertices.size(), 0);
  for (std::uint32_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
    std::uint32_t& vertex = mesh.triangles[c / 3][c % 3];
    const std::size_t root = fans.root(c);
    if (vertex < keeper.size() && keeper[vertex] == root) continue;
    if (vertex_of[root] == ~0u) {
      vertex_of[root] = static_cast<std::uint32_t>(mesh.vertices.size());
      surface.cut_vertices += std::exchange(cut[vertex], 1) == 0 ? 1 : 0;
      const Point at = mesh.vertices[vertex];
      mesh.vertices.push_back(at);
    }
    vertex = vertex_of[root];
  }
}

std::size_t drop_intersecting(TriangleMesh& mesh) {
  std::vector<std::vector<std::uint32_t>> meets(mesh.triangles.size());
  BoxPairs(triangle_boxes(mesh.view())).for_each([&](std::uint32_t i, std::uint32_t j) {
    if (!intersect_beyond_shared(mesh.view(), i, j)) return;
    meets[i].push_back(j);
    meets[j].push_back(i);
  });
  std::set<std::pair<std::size_t, std::uint32_t>> by_count;  // of pairs left, and the triangle
  for (std::uint32_t t = 0; t < meets.size(); ++t) {
    if (!meets[t].empty()) by_count.insert({meets[t].size(), t});
  }
  std::vector<std::size_t> left;
  left.reserve(meets.size());
  for (const std::vector<std::uint32_t>& pairs : meets) left.push_back(pairs.size());
  Flags flags(mesh.triangles.size(), 0);
  while (!by_count.empty()) {
    const std::uint32_t worst = by_count.rbegin()->second;
    by_count.erase(std::prev(by_count.end()));
    flags[worst] = 1;
    for (const std::uint32_t t : meets[worst]) {
      if (flags[t] != 0) continue;
      by_count.erase({left[t], t});
      if (--left[t] > 0) by_count.insert({left[t], t});
    }
  }
  return drop(mesh, flags);
}

// Drops triangles until the mesh is manifold.
std::size_t drop_non_manifold(TriangleMesh& mesh) {
  std::size_t dropped = 0;
  for (std::size_t last = 1; last > 0;) {
    last = drop_at_edges(mesh);
    last += drop_at_vertices(mesh);
    dropped += last;
    if (last > 0) orient_consistently(mesh);
  }
  return dropped;
}

// Returns the number of used vertices that were merged into others.
std::size_t merge_all(TriangleMesh& mesh) {
  drop_unused_vertices(mesh.vertices, mesh.triangles);
  const std::size_t before = mesh.vertices.size();
  merge_equal_vertices(mesh.vertices, mesh.triangles);
  return before - mesh.vertices.size();
}

}  // namespace

ManifoldPart manifold_part(TriangleMesh mesh) {
  require_usable(mesh);
  ManifoldPart part;
  merge_equal_vertices(mesh.vertices, mesh.triangles);
  part.dropped = drop_degenerate(mesh);
  orient_consistently(mesh);
  part.dropped += drop_intersecting(mesh);
  part.dropped += drop_non_manifold(mesh);
  drop_unused(mesh);
  part.mesh = std::move(mesh);
  return part;
}

CutSurface cut_to_manifold(TriangleMesh mesh) {
  require_usable(mesh);
  CutSurface surface;
  surface.merged = merge_all(mesh);
  for (std::size_t split = 1; split > 0;) {
    split = split_at_collinear(mesh);
    surface.split += split;
  }
  surface.dropped = drop_degenerate(mesh);
  surface.turned = orient_consistently(mesh);
  surface.mesh = std::move(mesh);
  cut_apart(surface);
  // An edge may still have two triangles whose both ends are joined around a triangle that was cut
  // off from it.
  surface.dropped += drop_non_manifold(surface.mesh);
  drop_unused(surface.mesh);
  return surface;
}

}  // namespace emax
