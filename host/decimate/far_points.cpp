#include "host/decimate/far_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/geometry/point_tree.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr std::size_t kMostTriangles = 24;  // triangles near a point where its insertion is tried
// Of far points, the share that is alone where noise made them. Normal noise that puts 2% of the
// points there leaves 92% of them alone.
constexpr double kNoise = 0.75;
constexpr std::size_t kNeighbours = 8;  // among which another point may be as far

class Insertion {
 public:
  Insertion(DecimationState& state, const JoiningDistance& far)
      : state_(state),
        squared_far_(far.with_others * far.with_others),
        squared_farther_(far.alone * far.alone) {}

  bool insert(std::uint32_t point) {
    const Point& p = state_.point(point);
    const std::uint32_t slot =
        state_.tree().nearest(state_.mesh(), p, std::numeric_limits<double>::infinity()).slot;
    if (slot == kNoIndex) return false;
    point_ = point;
    if (vertex_ == kNoIndex || state_.mesh().used(vertex_)) vertex_ = state_.add_vertex(p);
    for (const std::uint32_t place : places(slot)) {
      const Triangle t = state_.mesh().triangle(place);
      for (std::size_t i = 0; i < 3; ++i) {
        if (attach(place, t[i], t[(i + 1) % 3])) return true;
      }
      if (try_edit({place},
                   {{t[0], t[1], vertex_}, {t[1], t[2], vertex_}, {t[2], t[0], vertex_}})) {
        return true;
      }
      for (std::size_t i = 0; i < 3; ++i) {
        if (split(t[i], t[(i + 1) % 3])) return true;
      }
    }
    return false;
  }

 private:
  // The triangle and those around it, ordered by their distance from the point.
  std::vector<std::uint32_t> places(std::uint32_t slot) const {
    std::vector<std::pair<double, std::uint32_t>> near;
    for (const std::uint32_t v : state_.mesh().triangle(slot)) {
      state_.mesh().for_each_slot_at(v, [&](std::uint32_t s) {
        near.emplace_back(squared_distance(state_.point(point_), state_.mesh().corners(s)), s);
      });
    }
    sort_once(near);
    if (near.size() > kMostTriangles) near.resize(kMostTriangles);
    std::vector<std::uint32_t> slots;
    for (const auto& [distance, s] : near) slots.push_back(s);
    return slots;
  }

  // Adds a triangle on an edge of the boundary.
  bool attach(std::uint32_t slot, std::uint32_t from, std::uint32_t to) {
    if (state_.mesh().slots_at_edge(from, to)[1] != kNoIndex) return false;
    // This is only for a point that lies beyond the edge, not over the triangle.
    const Point& a = state_.mesh().position(from);
    const Point& b = state_.mesh().position(to);
    const Point& c = state_.mesh().position(opposite(state_.mesh().triangle(slot), from, to));
    const Point inward = (c - a) - (b - a) * ((c - a).dot(b - a) / (b - a).squaredNorm());
    if ((state_.point(point_) - a).dot(inward) >= 0) return false;
    return try_edit({}, {{to, from, vertex_}});
  }

  bool split(std::uint32_t from, std::uint32_t to) {
    std::vector<std::uint32_t> removed;
    std::vector<Triangle> added;
    for (const std::uint32_t slot : state_.mesh().slots_at_edge(from, to)) {
      if (slot == kNoIndex) continue;
      removed.push_back(slot);
      for (const std::uint32_t end : {from, to}) {
        Triangle t = state_.mesh().triangle(slot);
        std::replace(t.begin(), t.end(), end, vertex_);
        added.push_back(t);
      }
    }
    return try_edit(removed, added);
  }

  bool try_edit(const std::vector<std::uint32_t>& removed, const std::vector<Triangle>& added) {
    edit_.clear();
    edit_.vertex = vertex_;
    edit_.position = state_.point(point_);
    edit_.removed = removed;
    edit_.added = added;
    std::vector<std::array<Point, 3>> shapes;
    for (const Triangle& t : added) {
      std::array<Point, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = t[i] == vertex_ ? edit_.position : state_.mesh().position(t[i]);
      }
      if (!state_.well_shaped(local_frame(corners))) return false;
      shapes.push_back(corners);
    }
    edit_.answers.push_back({point_, 0, kNoIndex, squared_distance(edit_.position, shapes[0])});
    bool kept = true;
    for (const std::uint32_t slot : removed) {
      state_.assigned().for_each(slot, [&](std::uint32_t p) {
        if (p == point_) return;
        MeshEdit::Answer answer{p, 0, kNoIndex, std::numeric_limits<double>::infinity()};
        for (std::uint32_t i = 0; i < shapes.size(); ++i) {
          const double squared = squared_distance(state_.point(p), shapes[i]);
          if (squared >= answer.squared_distance) continue;
          answer.squared_distance = squared;
          answer.added = i;
        }
        const double before = state_.assigned().squared_distance(p);
        const double limit = before > squared_farther_ ? std::numeric_limits<double>::infinity()
                             : before > squared_far_   ? squared_farther_
                                                       : squared_far_;
        kept = kept && answer.squared_distance <= limit;
        edit_.answers.push_back(answer);
      });
    }
    if (!kept || !state_.permits(edit_)) return false;
    state_.apply(edit_);
    return true;
  }

  DecimationState& state_;
  double squared_far_, squared_farther_;
  std::uint32_t point_ = kNoIndex, vertex_ = kNoIndex;
  MeshEdit edit_;
};

bool is_farther(const DecimationState& state, std::uint32_t p, double distance) {
  const AssignedPoints& assigned = state.assigned();
  const double squared = distance * distance;
  const bool near = assigned.owner(p) != kNoIndex && assigned.squared_distance(p) <= squared;
  return !near && state.tree().nearest(state.mesh(), state.point(p), squared).slot == kNoIndex;
}

// A point that is farther than far.with_others, and whether it is joined even where noise is the
// reason for most.
struct Away {
  std::uint32_t point;
  Point from_mesh;
  bool is_joined;
};

// Marks those that have another one among their nearest, on the same side of the mesh, and returns
// how many have none.
std::size_t mark_with_others(std::vector<Away>& away, const DecimationState& state) {
  if (away.empty()) return 0;
  const PointTree tree(state.cloud());
  std::vector<PointTree::Neighbour> near;
  std::size_t alone = 0;
  for (Away& one : away) {
    tree.nearest(state.point(one.point), kNeighbours + 1, near);  // itself too
    const bool has_other = std::ranges::any_of(near, [&](const PointTree::Neighbour& n) {
      const auto other = std::ranges::lower_bound(away, n.index, {}, &Away::point);
      return n.index != one.point && other != away.end() && other->point == n.index &&
             other->from_mesh.dot(one.from_mesh) > 0;
    });
    one.is_joined = one.is_joined || has_other;
    if (!has_other) ++alone;
  }
  return alone;
}

// Ascending.
std::vector<std::uint32_t> points_to_join(const DecimationState& state, const JoiningDistance& far,
                                          const std::function<bool()>& interrupted) {
  std::vector<Away> away;
  const auto points = static_cast<std::uint32_t>(state.cloud().size());
  for (std::uint32_t p = 0; p < points; ++p) {
    if (!is_farther(state, p, far.with_others)) continue;
    if (interrupted && interrupted()) return {};
    const Point& at = state.point(p);
    const std::uint32_t slot =
        state.tree().nearest(state.mesh(), at, std::numeric_limits<double>::infinity()).slot;
    if (slot == kNoIndex) continue;
    const Foot foot = foot_on(local_frame(state.mesh().corners(slot)), at);
    away.push_back({p, foot.residual, is_farther(state, p, far.alone)});
  }
  const auto far_points = static_cast<double>(away.size());
  const bool all = far.alone <= far.with_others ||
                   static_cast<double>(mark_with_others(away, state)) <= kNoise * far_points;
  std::vector<std::uint32_t> joined;
  for (const Away& one : away) {
    if (all || one.is_joined) joined.push_back(one.point);
  }
  return joined;
}

}  // namespace

FarPoints insert_far_points(DecimationState& state, const JoiningDistance& far,
                            const std::function<bool()>& interrupted) {
  Insertion insertion(state, far);
  FarPoints result;
  const std::vector<std::uint32_t> joined = points_to_join(state, far, interrupted);
  bool stopped = interrupted && interrupted();
  for (const std::uint32_t p : joined) {
    if (stopped) break;
    if (!is_farther(state, p, far.with_others)) continue;
    stopped = interrupted && interrupted();
    if (!stopped && insertion.insert(p)) ++result.inserted;
  }
  // Later insertions may have brought the mesh within reach of a point.
  for (const std::uint32_t p : joined) {
    if (!stopped && is_farther(state, p, far.with_others)) result.left_out.push_back(p);
  }
  result.mesh = state.mesh().compact();
  return result;
}

}  // namespace emax
