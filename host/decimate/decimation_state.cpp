#include "host/decimate/decimation_state.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/geometry/triangle_pair.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/parallel.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr std::size_t kPollEvery = 16384;

// A normal, which consists of cross products, times a difference: each rounds by a few units of
// 2^-53.
constexpr double kPlaneRoundings = 0x1p-47;

SlotTree::Box joined(SlotTree::Box a, const SlotTree::Box& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    a.lower[i] = std::min(a.lower[i], b.lower[i]);
    a.upper[i] = std::max(a.upper[i], b.upper[i]);
  }
  return a;
}

Point area_normal_of(const std::array<Point, 3>& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

}  // namespace

DecimationState::DecimationState(const TriangleMesh& mesh, std::span<const Point> cloud,
                                 const BackBound* back, double squared_limit, const Guards& guards,
                                 const Interrupted& interrupted,
                                 std::span<const Triangle> reference)
    : mesh_(mesh),
      cloud_(cloud),
      points_(cloud.begin(), cloud.end()),
      back_(back),
      squared_limit_(squared_limit),
      guards_(guards),
      reference_(reference),
      assigned_(cloud.size(), mesh.triangles.size(), guards.guides),
      tree_(mesh_),
      sight_(mesh.vertices.size()) {
  use_threads(1);
  take_area_normals();
  for (const Triangle& t : reference_) {
    for (const std::uint32_t p : t) assigned_.make_guide(p);
  }
  complete_ = reassign(interrupted);
  if (complete_) cover_reference();
  if (!complete_ || back_ == nullptr) return;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    sight_[v] = back_->sight(mesh.vertices[v], v == 0 ? kNoIndex : sight_[v - 1].triangle);
  }
}

bool DecimationState::reassign(const Interrupted& interrupted) {
  constexpr std::size_t kPiece = 512;
  std::vector<SlotTree::Nearest> nearest(std::min<std::size_t>(points_.size(), kPollEvery));
  for (std::size_t begin = 0; begin < points_.size(); begin += kPollEvery) {
    if (interrupted && interrupted()) return false;
    const std::size_t count = std::min<std::size_t>(kPollEvery, points_.size() - begin);
    in_pieces(guards_.threads, count, kPiece,
              [&](std::size_t, std::size_t first, std::size_t last) {
                std::uint32_t hint = kNoIndex;
                for (std::size_t i = first; i < last; ++i) {
                  const auto p = static_cast<std::uint32_t>(begin + i);
                  nearest[i] = {kNoIndex, 0};
                  if (guides_alone_ && !assigned_.is_guide(p)) continue;
                  nearest[i] = nearest_of(p, hint);
                  if (nearest[i].slot != kNoIndex) hint = nearest[i].slot;
                }
              });
    for (std::size_t i = 0; i < count; ++i) {
      const auto p = static_cast<std::uint32_t>(begin + i);
      const bool known = assigned_.owner(p) != kNoIndex;
      if (nearest[i].slot == kNoIndex) continue;
      if (known && nearest[i].squared_distance >= assigned_.squared_distance(p)) continue;
      assigned_.assign(p, nearest[i].slot, nearest[i].squared_distance);
    }
  }
  return true;
}

// Within slightly more than the known distance, so that the point's triangle is found again. The
// hint is for points that have none. If the triangle was taken from it, the hint is enough where it
// is within the limit, and the nearest is found wherever it is otherwise.
SlotTree::Nearest DecimationState::nearest_of(std::uint32_t point, std::uint32_t hint) const {
  const std::uint32_t owner = assigned_.owner(point);
  const bool detached = assigned_.detached(point);
  if (detached && hint != kNoIndex) {
    const double squared = squared_distance(points_[point], mesh_.corners(hint));
    if (squared <= squared_limit_) return {hint, squared};
  }
  const bool has_none = owner == kNoIndex && !detached;
  const double known = has_none ? std::max(squared_limit_, guards_.squared_reach)
                                : assigned_.squared_distance(point);
  return tree_.nearest(mesh_, points_[point],
                       known * (1 + 1e-9) + std::numeric_limits<double>::min(),
                       owner == kNoIndex ? hint : owner);
}

std::uint32_t DecimationState::add_vertex(const Point& at) {
  sight_.push_back(back_ == nullptr ? BackBound::Sight{} : back_->sight(at));
  return mesh_.add_vertex(at);
}

bool DecimationState::permits(const MeshEdit& edit, BackVerdict back, bool tolerant) {
  judged_ = std::move(back);
  if (!judged_.keeps) return false;
  const Point before = edit.vertex == kNoIndex ? Point::Zero() : mesh_.position(edit.vertex);
  if (edit.vertex != kNoIndex) mesh_.move(edit.vertex, edit.position);
  const bool covers = loosened() || !cover_ || cover_->permits(mesh_, assigned_, edit, tolerant);
  const bool meets =
      covers && !EMAX_FAULT(kSkipsIntersections) && (meets_itself(edit) || meets_another(edit));
  const std::size_t after = meets ? crossings(edit.added, edit.removed) : 0;
  if (edit.vertex != kNoIndex) mesh_.move(edit.vertex, before);
  if (!meets) return covers;
  removed_.clear();
  for (const std::uint32_t slot : edit.removed) removed_.push_back(mesh_.triangle(slot));
  return after <= crossings(removed_, edit.removed);
}

void DecimationState::use_threads(std::size_t threads) {
  while (back_ != nullptr && searches_.size() < threads) searches_.push_back(back_->make_search());
}

DecimationState::BackVerdict DecimationState::judge_back(const MeshEdit& edit,
                                                         std::size_t thread) const {
  BackVerdict verdict;
  verdict.added_break.assign(edit.added.size(), 0);
  if (back_ == nullptr) return verdict;
  BackBound::Sight& moved = verdict.moved;
  if (edit.vertex != kNoIndex) {
    moved = back_->sight_from(edit.position, sight_[edit.vertex].triangle);
    if (!(moved.share <= permitted_back_)) moved = back_->sight(edit.position, moved.triangle);
  }
  if (!EMAX_FAULT(kSkipsBackBound)) verdict.keeps = keeps_back_bound(edit, verdict, thread);
  return verdict;
}

bool DecimationState::keeps_back_bound(const MeshEdit& edit, BackVerdict& verdict,
                                       std::size_t thread) const {
  const BackBound::Sight& moved = verdict.moved;
  if (edit.vertex != kNoIndex && !(moved.share <= permitted_back_) &&
      !(may_stay_beyond_ && moved.share <= sight_[edit.vertex].share)) {
    return false;
  }
  if (loosened()) return true;
  auto spare = std::ranges::count_if(edit.removed,
                                     [&](std::uint32_t slot) { return breaks_back_bound(slot); });
  // The parts of a triangle that was beyond are smaller, so that they are nearer even where several
  // are beyond.
  const bool splits = edit.added.size() > edit.removed.size();
  if (splits && spare > 0) spare = std::ssize(edit.added);
  const auto position = [&](std::uint32_t v) {
    return v == edit.vertex ? edit.position : mesh_.position(v);
  };
  for (std::size_t k = 0; k < edit.added.size(); ++k) {
    const Triangle& t = edit.added[k];
    // Begins at the vertex that moved, or at any vertex if none did.
    std::size_t i = 0;
    if (edit.vertex != kNoIndex) {
      while (i < 2 && t[i] != edit.vertex) ++i;
    }
    const std::uint32_t near = t[i] == edit.vertex ? moved.triangle : sight_[t[i]].triangle;
    const std::array<Point, 3> corners = {position(t[i]), position(t[(i + 1) % 3]),
                                          position(t[(i + 2) % 3])};
    if (back_->holds(corners, near, *searches_[thread])) continue;
    if (spare-- <= 0) return false;
    verdict.added_break[k] = 1;
  }
  return true;
}

// Number of pairs that meet: the triangles with each other and with those of the mesh that stay.
std::size_t DecimationState::crossings(std::span<const Triangle> triangles,
                                       std::span<const std::uint32_t> removed) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t j = i + 1; j < triangles.size(); ++j) {
      if (intersect_beyond_shared({mesh_.positions(), triangles}, i, j)) ++count;
    }
    const std::array<Point, 3> corners = {mesh_.position(triangles[i][0]),
                                          mesh_.position(triangles[i][1]),
                                          mesh_.position(triangles[i][2])};
    tree_.for_each_overlap(
        tree_.rounded(bounds_of(corners)), [&](std::uint32_t slot, const SlotTree::Box&) {
          const std::array<Triangle, 2> pair = {triangles[i], mesh_.triangle(slot)};
          const bool stays = std::ranges::find(removed, slot) == removed.end();
          if (stays && intersect_beyond_shared({mesh_.positions(), pair}, 0, 1)) ++count;
          return true;
        });
  }
  return count;
}

bool DecimationState::meets_itself(const MeshEdit& edit) const {
  const MeshView view{mesh_.positions(), edit.added};
  for (std::size_t i = 0; i < edit.added.size(); ++i) {
    for (std::size_t j = i + 1; j < edit.added.size(); ++j) {
      if (intersect_beyond_shared(view, i, j)) return true;
    }
  }
  return false;
}

bool DecimationState::meets_another(const MeshEdit& edit) {
  tested_.clear();
  SlotTree::Box around{};
  for (const Triangle& t : edit.added) {
    const std::array<Point, 3> c = {mesh_.position(t[0]), mesh_.position(t[1]),
                                    mesh_.position(t[2])};
    tested_.push_back({tree_.rounded(bounds_of(c)), c[0], area_normal_of(c),
                       kPlaneRoundings * (c[1] - c[0]).norm() * (c[2] - c[0]).norm()});
    around = tested_.size() == 1 ? tested_.front().box : joined(around, tested_.back().box);
  }
  return !tree_.for_each_overlap(around, [&](std::uint32_t slot, const SlotTree::Box& box) {
    if (std::find(edit.removed.begin(), edit.removed.end(), slot) != edit.removed.end()) {
      return true;
    }
    const Triangle& other = mesh_.triangle(slot);
    for (std::size_t i = 0; i < edit.added.size(); ++i) {
      const Tested& tested = tested_[i];
      if (!overlap(tested.box, box)) continue;
      // A triangle does not meet this one if all of its vertices that the two do not share lie on
      // one side of this one's plane.
      const Triangle& t = edit.added[i];
      int above = 0, below = 0, shared = 0;
      for (const std::uint32_t v : other) {
        if (has(t, v)) {
          ++shared;
          continue;
        }
        const Point d = mesh_.position(v) - tested.corner;
        const double side = tested.normal.dot(d), roundings = tested.roundings * d.norm();
        above += side > roundings ? 1 : 0;
        below += side < -roundings ? 1 : 0;
      }
      if (shared + std::max(above, below) == 3 && shared < 3) continue;
      const std::array<Triangle, 2> pair = {t, other};
      if (intersect_beyond_shared({mesh_.positions(), pair}, 0, 1)) return false;
    }
    return true;
  });
}

void DecimationState::apply(const MeshEdit& edit, EditUndo* undo) {
  if (undo != nullptr) {
    undo->slots.clear();
    undo->answers.clear();
    undo->cover = {};
    undo->vertex = edit.vertex;
    for (const std::uint32_t slot : edit.removed) {
      undo->slots.push_back({slot, mesh_.triangle(slot)});
    }
    for (const MeshEdit::Answer& a : edit.answers) {
      undo->answers.push_back(
          {a.point, kNoIndex, assigned_.owner(a.point), assigned_.squared_distance(a.point)});
    }
    if (edit.vertex != kNoIndex) {
      undo->position = mesh_.position(edit.vertex);
      undo->sight = sight_[edit.vertex];
    }
  }
  take_shapes(edit);
  for (const std::uint32_t slot : edit.removed) mesh_.clear(slot);
  if (edit.vertex != kNoIndex) {
    mesh_.move(edit.vertex, edit.position);
    if (back_ != nullptr) sight_[edit.vertex] = judged_.moved;
  }
  placed_.clear();
  for (std::size_t i = 0; i < edit.added.size(); ++i) {
    std::uint32_t slot = kNoIndex;
    if (i < edit.removed.size()) {
      slot = edit.removed[i];
    } else {
      slot = mesh_.add_slot();
      if (undo != nullptr) undo->slots.push_back({slot, {kNoIndex, kNoIndex, kNoIndex}});
    }
    mesh_.set(slot, edit.added[i]);
    placed_.push_back(slot);
  }
  if (!breaks_back_.empty()) {
    breaks_back_.resize(mesh_.slots(), 0);
    for (const std::uint32_t slot : edit.removed) breaks_back_[slot] = 0;
    for (std::size_t i = 0; i < placed_.size(); ++i)
      breaks_back_[placed_[i]] = judged_.added_break[i];
  }
  if (cover_ && !loosened()) cover_->apply(placed_, undo == nullptr ? nullptr : &undo->cover);
  assigned_.add_slots(mesh_.slots());
  for (const MeshEdit::Answer& a : edit.answers) {
    assigned_.assign(a.point, a.added == kNoIndex ? a.slot : placed_[a.added], a.squared_distance);
  }
  for (const std::uint32_t slot : edit.removed) changed(slot);
  for (std::size_t i = edit.removed.size(); i < placed_.size(); ++i) changed(placed_[i]);
  if (tree_.outgrown(mesh_)) tree_.rebuild(mesh_);
}

void DecimationState::follow(std::vector<Shape> shapes, std::vector<std::uint32_t> shape_of) {
  shapes_ = std::move(shapes);
  shape_of_ = std::move(shape_of);
}

// Of the slots that added triangles will have: those of the removed ones first, then new ones. A
// split adds as many triangles for each that it removes, in their order.
void DecimationState::take_shapes(const MeshEdit& edit) {
  if (shape_of_.empty() || edit.added.size() <= edit.removed.size()) return;
  const std::size_t parts = edit.added.size() / edit.removed.size();
  std::vector<std::uint32_t> shapes;
  for (std::size_t k = 0; k < edit.added.size(); ++k) {
    shapes.push_back(shape_of(edit.removed[k / parts]));
  }
  shape_of_.resize(mesh_.slots(), kNoIndex);
  for (std::size_t k = 0; k < edit.added.size(); ++k) {
    if (k < edit.removed.size()) {
      shape_of_[edit.removed[k]] = shapes[k];
    } else {
      shape_of_.push_back(shapes[k]);  // EditableMesh::add_slot() appends
    }
  }
}

void DecimationState::cover_reference() {
  if (reference_.empty() || EMAX_FAULT(kSkipsReference)) return;
  cover_.emplace(reference_, cloud_, squared_limit_, guards_.recalls);
  cover_->begin(mesh_, tree_);
}

void DecimationState::loosen(double factor, double back_factor) {
  detach_others();
  permitted_ = factor * factor;
  permitted_back_ = back_factor * back_factor;
  may_stay_beyond_ = true;
}

void DecimationState::tighten() {
  permitted_ = permitted_back_ = 1;
  may_stay_beyond_ = true;
  reassign();
  test_back_bound();
  cover_reference();
}

void DecimationState::detach_others() {
  guides_alone_ = !assigned_.all_are_guides();
  assigned_.detach_others();
}

std::size_t DecimationState::attach_others() {
  if (!guides_alone_) return 0;
  guides_alone_ = false;
  reassign();
  std::size_t beyond = 0;
  for (std::uint32_t p = 0; p < assigned_.size(); ++p) {
    if (assigned_.is_guide(p) || assigned_.squared_distance(p) <= squared_limit_) continue;
    assigned_.make_guide(p);
    ++beyond;
  }
  return beyond;
}

void DecimationState::test_back_bound() {
  if (back_ == nullptr) return;
  breaks_back_.assign(mesh_.slots(), 0);
  std::vector<std::uint32_t> slots = mesh_.alive_slots();
  std::vector<std::uint32_t> first;  // a corner of each
  for (const std::uint32_t slot : slots) first.push_back(mesh_.triangle(slot)[0]);
  sort_once(first);
  constexpr std::size_t kPiece = 64;
  in_pieces(guards_.threads, first.size(), kPiece,
            [&](std::size_t, std::size_t begin, std::size_t end) {
              for (std::size_t i = begin; i < end; ++i) {
                BackBound::Sight& sight = sight_[first[i]];
                sight = back_->sight(mesh_.position(first[i]), sight.triangle);
              }
            });
  use_threads(guards_.threads);
  in_pieces(
      guards_.threads, slots.size(), kPiece,
      [&](std::size_t thread, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t slot = slots[i], near = sight_[mesh_.triangle(slot)[0]].triangle;
          breaks_back_[slot] = back_->holds(mesh_.corners(slot), near, *searches_[thread]) ? 0 : 1;
        }
      });
}

bool DecimationState::keep_limits() {
  if (unproven() > 0 || std::ranges::count(breaks_back_, 1) > 0) return false;
  for (std::uint32_t p = 0; p < assigned_.size(); ++p) {
    const bool known = assigned_.owner(p) != kNoIndex || assigned_.detached(p);
    if (known && assigned_.squared_distance(p) > squared_limit_) return false;
  }
  may_stay_beyond_ = false;
  breaks_back_.clear();
  return true;
}

void DecimationState::prove_all() {
  if (unproven() == 0) return;
  for (std::uint32_t t = 0; t < reference_.size(); ++t) cover_->prove(t, mesh_, tree_);
}

std::size_t DecimationState::add_witnesses() {
  constexpr int kSteps = 8;
  const std::size_t before = points_.size();
  if (unproven() == 0) return 0;
  for (std::uint32_t t = 0; t < reference_.size(); ++t) {
    if (cover_->proven(t)) continue;
    const Point &a = points_[reference_[t][0]], &b = points_[reference_[t][1]],
                &c = points_[reference_[t][2]];
    Point farthest = a;
    SlotTree::Nearest nearest{kNoIndex, squared_limit_};
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Point p = a + (i * (b - a) + j * (c - a)) / kSteps;
        const SlotTree::Nearest of_p =
            tree_.nearest(mesh_, p, std::numeric_limits<double>::infinity(), nearest.slot);
        if (!(of_p.squared_distance > nearest.squared_distance)) continue;
        farthest = p;
        nearest = of_p;
      }
    }
    if (nearest.slot == kNoIndex) continue;
    points_.push_back(farthest);
    assigned_.assign(assigned_.add_point(), nearest.slot, nearest.squared_distance);
  }
  return points_.size() - before;
}

std::vector<std::uint32_t> DecimationState::around_unproven() const {
  std::vector<std::uint32_t> slots;
  if (unproven() == 0) return slots;
  for (std::uint32_t t = 0; t < reference_.size(); ++t) {
    if (cover_->proven(t)) continue;
    for (const std::uint32_t p : reference_[t]) {
      if (assigned_.owner(p) != kNoIndex) slots.push_back(assigned_.owner(p));
    }
  }
  sort_once(slots);
  return slots;
}

void DecimationState::restore(const Snapshot& snapshot) {
  mesh_ = snapshot.mesh;
  assigned_ = snapshot.assigned;
  points_.resize(assigned_.size());
  sight_ = snapshot.sight;
  shape_of_ = snapshot.shape_of;
  permitted_ = permitted_back_ = 1;
  may_stay_beyond_ = guides_alone_ = false;
  breaks_back_.clear();
  tree_.rebuild(mesh_);
  take_area_normals();
  cover_reference();
}

void DecimationState::take_area_normals() {
  area_normals_.assign(mesh_.slots(), Point::Zero());
  for (std::uint32_t slot = 0; slot < mesh_.slots(); ++slot) {
    if (mesh_.alive(slot)) area_normals_[slot] = area_normal_of(mesh_.corners(slot));
  }
}

void DecimationState::place_vertex(std::uint32_t vertex, const Point& at, std::uint32_t near) {
  mesh_.move(vertex, at);
  if (back_ != nullptr) sight_[vertex] = back_->sight(at, sight_[near].triangle);
}

void DecimationState::changed(std::uint32_t slot) {
  tree_.update(mesh_, slot);
  area_normals_.resize(mesh_.slots());
  if (mesh_.alive(slot)) area_normals_[slot] = area_normal_of(mesh_.corners(slot));
}

void DecimationState::undo(const EditUndo& undo) {
  for (const EditUndo::Slot& s : undo.slots) {
    if (mesh_.alive(s.slot)) mesh_.clear(s.slot);
  }
  if (undo.vertex != kNoIndex) {
    mesh_.move(undo.vertex, undo.position);
    sight_[undo.vertex] = undo.sight;
  }
  for (const EditUndo::Slot& s : undo.slots) {
    if (s.before[0] != kNoIndex) mesh_.set(s.slot, s.before);
  }
  for (const MeshEdit::Answer& a : undo.answers) {
    assigned_.assign(a.point, a.slot, a.squared_distance);
  }
  for (const EditUndo::Slot& s : undo.slots) changed(s.slot);
  if (cover_ && !loosened()) cover_->undo(undo.cover);
}

}  // namespace emax
