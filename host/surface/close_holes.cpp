#include "host/surface/close_holes.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "host/geometry/bounds.h"
#include "host/geometry/box_pairs.h"
#include "host/geometry/triangle_pair.h"
#include "host/surface/cracks.h"
#include "host/surface/mesh_orientation.h"

namespace emax {
namespace {

constexpr double kFoldsBack = -0.5;  // cosine: a sharper turn than 120 degrees folds back
constexpr std::uint32_t kNoIndex = ~0u;

struct DirectedEdge {
  std::uint32_t from, to;
};

// The triangles around each vertex of a mesh, and the mesh's holes.
class Adjacency {
 public:
  explicit Adjacency(const TriangleMesh& mesh) : mesh_(mesh), first_(mesh.vertices.size() + 1, 0) {
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) ++first_[v + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    around_.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> next = first_;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) around_[next[v]++] = t;
    }
    find_holes();
  }

  // The triangle that has this directed edge, or kNoIndex.
  std::uint32_t triangle(std::uint32_t from, std::uint32_t to) const {
    for (const std::uint32_t t : around(from)) {
      const Triangle& triangle = mesh_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        if (triangle[k] == from && triangle[(k + 1) % 3] == to) return t;
      }
    }
    return kNoIndex;
  }

  std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return std::span(around_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }

  // Each hole's vertices in the direction of the triangles that would close it.
  const std::vector<std::vector<std::uint32_t>>& holes() const { return holes_; }
  // The hole of a vertex, or kNoIndex.
  std::uint32_t hole_at(std::uint32_t vertex) const {
    const auto found = hole_at_.find(vertex);
    return found == hole_at_.end() ? kNoIndex : found->second;
  }

 private:
  void find_holes() {
    std::unordered_map<std::uint32_t, std::uint32_t> next;
    std::vector<std::uint32_t> starts;
    for (const Triangle& t : mesh_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        if (triangle(to, from) != kNoIndex) continue;
        next[to] = from;
        starts.push_back(to);
      }
    }
    for (const std::uint32_t start : starts) {
      std::vector<std::uint32_t> hole;
      const auto name = static_cast<std::uint32_t>(holes_.size());
      for (std::uint32_t v = start; hole_at_.try_emplace(v, name).second; v = next.at(v)) {
        hole.push_back(v);
      }
      if (!hole.empty()) holes_.push_back(std::move(hole));
    }
  }

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> first_, around_;  // around v: first_[v] to first_[v + 1]
  std::vector<std::vector<std::uint32_t>> holes_;
  std::unordered_map<std::uint32_t, std::uint32_t> hole_at_;
};

// Which holes are cracks. With an infinite `crack` all of them are.
std::vector<bool> cracks_of(const TriangleMesh& mesh, const Adjacency& adjacency, double crack) {
  if (crack == std::numeric_limits<double>::infinity()) {
    return std::vector<bool>(adjacency.holes().size(), true);
  }
  std::vector<std::vector<RimEdge>> loops;
  for (const std::vector<std::uint32_t>& hole : adjacency.holes()) {
    std::vector<RimEdge>& loop = loops.emplace_back();
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const std::uint32_t from = hole[(i + 1) % hole.size()], to = hole[i];
      for (const std::uint32_t v : mesh.triangles[adjacency.triangle(from, to)]) {
        if (v != from && v != to) {
          loop.push_back({mesh.vertices[from], mesh.vertices[to], mesh.vertices[v]});
        }
      }
    }
  }
  return find_cracks(loops, mesh.vertices, crack);
}

// A hole and the triangles around it that are dropped, with the patches that close it.
class Opening {
 public:
  // Holes that are not `allowed` stay open, triangles from `first_kept` on stay.
  Opening(const TriangleMesh& mesh, const Adjacency& adjacency, double farthest,
          std::size_t most_edges, const std::vector<bool>& allowed, std::size_t first_kept)
      : mesh_(mesh),
        adjacency_(adjacency),
        farthest_(farthest),
        most_edges_(most_edges),
        allowed_(allowed),
        first_kept_(first_kept) {}

  // Returns false where the hole cannot be closed.
  bool close(std::uint32_t hole, int rings) {
    if (!take(hole)) return false;
    if (!trace()) return false;
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<std::uint32_t> rim;
      for (const auto& loop : loops_) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          rim.push_back(adjacency_.triangle(loop[(i + 1) % loop.size()], loop[i]));
        }
      }
      if (!drop(rim) || !trace()) return false;
    }
    return std::ranges::all_of(loops_, [&](const auto& loop) { return patch(loop); });
  }

  const std::unordered_set<std::uint32_t>& dropped() const { return dropped_; }
  const std::vector<Triangle>& patches() const { return patches_; }
  std::size_t holes() const { return holes_.size(); }

  // Vertices of the dropped triangles and of the patches.
  std::vector<std::uint32_t> touched() const {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t t : dropped_) {
      all.insert(all.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    }
    for (const auto& loop : loops_) all.insert(all.end(), loop.begin(), loop.end());
    return all;
  }

 private:
  bool take(std::uint32_t hole) {
    if (!allowed_[hole] || !small_enough(adjacency_.holes()[hole])) return false;
    holes_.insert(hole);
    return true;
  }

  bool drop(std::span<const std::uint32_t> triangles) {
    for (const std::uint32_t t : triangles) {
      if (!dropped_.insert(t).second) continue;
      if (t >= first_kept_) return false;
      // Another hole at a vertex of the triangle becomes part of this one.
      for (const std::uint32_t v : mesh_.triangles[t]) {
        const std::uint32_t hole = adjacency_.hole_at(v);
        if (hole != kNoIndex && !holes_.contains(hole) && !take(hole)) return false;
      }
    }
    return true;
  }

  bool is_left(std::uint32_t t) const { return t != kNoIndex && !dropped_.contains(t); }

  // Traces the edges that triangles which stay have at the opening, as loops. Where a loop would
  // touch itself, all triangles at that vertex are dropped.
  bool trace() {
    for (;;) {
      std::unordered_map<std::uint32_t, std::uint32_t> next;
      std::vector<std::uint32_t> starts, pinched;
      const auto add = [&](std::uint32_t from, std::uint32_t to) {
        if (!is_left(adjacency_.triangle(to, from))) return;
        if (const auto [at, fresh] = next.try_emplace(from, to); fresh) {
          starts.push_back(from);
        } else if (at->second != to) {
          pinched.push_back(from);
        }
      };
      for (const DirectedEdge& e : edges()) add(e.from, e.to);
      if (pinched.empty()) {
        loops_.clear();
        std::unordered_set<std::uint32_t> seen;
        for (const std::uint32_t start : starts) {
          std::vector<std::uint32_t> loop;
          for (std::uint32_t v = start; seen.insert(v).second; v = next.at(v)) loop.push_back(v);
          if (!loop.empty()) loops_.push_back(std::move(loop));
        }
        return !loops_.empty() &&
               std::ranges::all_of(loops_, [&](const auto& loop) { return small_enough(loop); });
      }
      for (const std::uint32_t v : pinched) {
        if (!drop(adjacency_.around(v))) return false;
      }
    }
  }

  // The edges of the holes and of the dropped triangles, in the direction of the triangles that
  // would take their place. The order depends on the mesh alone.
  std::vector<DirectedEdge> edges() const {
    std::vector<DirectedEdge> all;
    std::vector<std::uint32_t> names(holes_.begin(), holes_.end());
    std::ranges::sort(names);
    for (const std::uint32_t name : names) {
      const auto& hole = adjacency_.holes()[name];
      for (std::size_t i = 0; i < hole.size(); ++i) {
        all.push_back({hole[i], hole[(i + 1) % hole.size()]});
      }
    }
    std::vector<std::uint32_t> triangles(dropped_.begin(), dropped_.end());
    std::ranges::sort(triangles);
    for (const std::uint32_t t : triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        all.push_back({mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]});
      }
    }
    return all;
  }

  bool small_enough(const std::vector<std::uint32_t>& loop) const {
    if (loop.size() < 3 || loop.size() > most_edges_) return false;
    Point mean = Point::Zero();
    for (const std::uint32_t v : loop) {
      mean += mesh_.vertices[v] / static_cast<double>(loop.size());
    }
    return std::ranges::all_of(
        loop, [&](std::uint32_t v) { return (mesh_.vertices[v] - mean).norm() <= farthest_; });
  }

  bool patch(const std::vector<std::uint32_t>& loop) {
    std::vector<Point> hole, behind;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
      hole.push_back(mesh_.vertices[from]);
      for (const std::uint32_t v : mesh_.triangles[adjacency_.triangle(to, from)]) {
        if (v != from && v != to) behind.push_back(mesh_.vertices[v]);
      }
    }
    const auto may_join = [&](std::size_t i, std::size_t j) {
      return !is_left(adjacency_.triangle(loop[i], loop[j])) &&
             !is_left(adjacency_.triangle(loop[j], loop[i]));
    };
    const std::optional<HolePatch> best = best_patch(hole, behind, may_join);
    if (!best || best->quality.fold <= kFoldsBack) return false;
    for (const auto& [a, b, c] : best->triangles) patches_.push_back({loop[a], loop[b], loop[c]});
    return true;
  }

  const TriangleMesh& mesh_;
  const Adjacency& adjacency_;
  double farthest_;
  std::size_t most_edges_;
  const std::vector<bool>& allowed_;  // of the holes
  std::size_t first_kept_;
  std::unordered_set<std::uint32_t> holes_, dropped_;
  std::vector<std::vector<std::uint32_t>> loops_;
  std::vector<Triangle> patches_;
};

// Which openings have patches that meet the mesh or other patches beyond the vertices and edges
// that they share.
std::vector<bool> intersecting(const TriangleMesh& mesh, std::span<const Opening> openings) {
  const std::size_t given = mesh.triangles.size();
  TriangleMesh all = mesh;
  std::vector<std::uint32_t> owner;
  for (std::uint32_t o = 0; o < openings.size(); ++o) {
    const std::vector<Triangle>& patches = openings[o].patches();
    all.triangles.insert(all.triangles.end(), patches.begin(), patches.end());
    owner.resize(all.triangles.size() - given, o);
  }
  std::vector<bool> bad(openings.size(), false);
  BoxPairs(triangle_boxes(all.view())).for_each([&](std::uint32_t i, std::uint32_t j) {
    if (i > j) std::swap(i, j);
    if (j < given) return;
    const std::uint32_t o = owner[j - given];
    if (i < given && openings[o].dropped().contains(i)) return;
    // Triangles that another opening drops count, too: they may come back.
    if (intersect_beyond_shared(all.view(), i, j)) bad[o] = true;
  });
  return bad;
}

// Closes the openings whose patches meet nothing.
void apply(std::span<const Opening> openings, TriangleMesh& mesh, ClosedHoles& result) {
  if (openings.empty()) return;
  const std::vector<bool> bad = intersecting(mesh, openings);
  std::vector<bool> drops(mesh.triangles.size(), false);
  std::vector<Triangle> added;
  for (std::size_t o = 0; o < openings.size(); ++o) {
    if (bad[o]) continue;
    for (const std::uint32_t t : openings[o].dropped()) drops[t] = true;
    added.insert(added.end(), openings[o].patches().begin(), openings[o].patches().end());
    result.closed += openings[o].holes();
    result.dropped += openings[o].dropped().size();
  }
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < drops.size(); ++t) {
    if (!drops[t]) kept.push_back(mesh.triangles[t]);
  }
  kept.insert(kept.end(), added.begin(), added.end());
  mesh.triangles = std::move(kept);
}

// Those openings that `close` closes and that touch none before them.
template <class Close>
std::vector<Opening> openings_of(const Adjacency& adjacency, const Close& close) {
  std::vector<Opening> openings;
  std::unordered_set<std::uint32_t> touched;
  for (std::uint32_t hole = 0; hole < adjacency.holes().size(); ++hole) {
    std::optional<Opening> opening = close(hole);
    if (!opening) continue;
    const std::vector<std::uint32_t> touches = opening->touched();
    if (std::ranges::any_of(touches, [&](std::uint32_t v) { return touched.contains(v); })) {
      continue;
    }
    touched.insert(touches.begin(), touches.end());
    openings.push_back(std::move(*opening));
  }
  return openings;
}

HoleRim rim_of(const TriangleMesh& mesh, const Adjacency& adjacency, std::uint32_t hole) {
  HoleRim rim{adjacency.holes()[hole], {}};
  for (std::size_t i = 0; i < rim.vertices.size(); ++i) {
    const std::uint32_t from = rim.vertices[(i + 1) % rim.vertices.size()], to = rim.vertices[i];
    rim.triangles.push_back(mesh.triangles[adjacency.triangle(from, to)]);
  }
  return rim;
}

}  // namespace

ClosedHoles close_holes(TriangleMesh mesh, double size, double crack, std::size_t most_edges) {
  ClosedHoles result;
  const double farthest = size * bounds_of(mesh.vertices).width();
  for (int rings = 0; rings <= kRimRings; ++rings) {
    const Adjacency adjacency(mesh);
    const std::vector<bool> cracks = cracks_of(mesh, adjacency, crack);
    const auto close = [&](std::uint32_t hole) -> std::optional<Opening> {
      Opening opening(mesh, adjacency, farthest, most_edges, cracks, mesh.triangles.size());
      if (!opening.close(hole, rings)) return std::nullopt;
      return opening;
    };
    apply(openings_of(adjacency, close), mesh, result);
  }
  drop_unused(mesh);
  result.mesh = std::move(mesh);
  return result;
}

ClosedHoles close_chosen_holes(TriangleMesh mesh, const HoleChoice& choice,
                               std::size_t most_edges) {
  ClosedHoles result;
  const std::size_t given = mesh.triangles.size();
  for (int rings = 0; rings <= kRimRings; ++rings) {
    const Adjacency adjacency(mesh);
    std::vector<HoleRim> rims;
    std::vector<bool> allowed;
    for (std::uint32_t hole = 0; hole < adjacency.holes().size(); ++hole) {
      rims.push_back(rim_of(mesh, adjacency, hole));
      allowed.push_back(choice.may_close(rims.back()));
    }
    const auto close = [&](std::uint32_t hole) -> std::optional<Opening> {
      Opening opening(mesh, adjacency, std::numeric_limits<double>::infinity(), most_edges, allowed,
                      given - result.dropped);
      if (!opening.close(hole, rings)) return std::nullopt;
      std::vector<Triangle> dropped;
      for (const std::uint32_t t : opening.dropped()) dropped.push_back(mesh.triangles[t]);
      std::ranges::sort(dropped);
      if (!choice.permits(rims[hole], opening.patches(), dropped)) return std::nullopt;
      return opening;
    };
    apply(openings_of(adjacency, close), mesh, result);
  }
  result.mesh = std::move(mesh);
  return result;
}

ClosedSurface close_surface(TriangleMesh mesh) {
  constexpr double kAnySize = 1;  // as wide as the mesh
  ClosedHoles holes = close_holes(std::move(mesh), kAnySize,
                                  std::numeric_limits<double>::infinity(), kMostClosedEdges);
  ClosedSurface surface{std::move(holes.mesh), holes.closed, {}};
  const Adjacency adjacency(surface.mesh);
  for (const std::vector<std::uint32_t>& loop : adjacency.holes()) {
    OpenBorder border{loop.size(), Point::Zero(), 0};
    for (const std::uint32_t v : loop) {
      border.middle += surface.mesh.vertices[v] / static_cast<double>(loop.size());
    }
    for (const std::uint32_t v : loop) {
      border.radius = std::max(border.radius, (surface.mesh.vertices[v] - border.middle).norm());
    }
    surface.open.push_back(border);
  }
  return surface;
}

std::size_t count_cracks(const TriangleMesh& mesh, double crack) {
  const std::vector<bool> cracks = cracks_of(mesh, Adjacency(mesh), crack);
  return static_cast<std::size_t>(std::ranges::count(cracks, true));
}

}  // namespace emax
