#include "host/decimate/decimation_state.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "host/geometry/triangle_pair.h"

namespace emax {
namespace {

Point area_normal_of(const std::array<Point, 3>& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

}  // namespace

DecimationState::DecimationState(const TriangleMesh& mesh, std::span<const Point> cloud,
                                 const BackBound* back, double squared_limit, const Guards& guards)
    : mesh_(mesh),
      cloud_(cloud),
      back_(back),
      squared_limit_(squared_limit),
      guards_(guards),
      assigned_(cloud.size(), mesh.triangles.size()),
      tree_(mesh_),
      area_normals_(mesh.triangles.size()),
      sight_(mesh.vertices.size()) {
  for (std::uint32_t slot = 0; slot < mesh_.slots(); ++slot) {
    area_normals_[slot] = area_normal_of(mesh_.corners(slot));
  }
  reassign();
  if (back_ == nullptr) return;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    sight_[v] = back_->sight(mesh.vertices[v]);
  }
}

void DecimationState::reassign() {
  for (std::uint32_t p = 0; p < cloud_.size(); ++p) {
    const std::uint32_t owner = assigned_.owner(p);
    // A little more than the distance known, so that its triangle is found again.
    const double known = owner == kNoIndex ? squared_limit_ : assigned_.squared_distance(p);
    const SlotTree::Nearest nearest =
        tree_.nearest(mesh_, cloud_[p], known * (1 + 1e-9) + std::numeric_limits<double>::min());
    if (nearest.slot == kNoIndex) continue;
    if (owner != kNoIndex && nearest.squared_distance >= assigned_.squared_distance(p)) continue;
    assigned_.assign(p, nearest.slot, nearest.squared_distance);
  }
}

std::uint32_t DecimationState::add_vertex(const Point& at) {
  sight_.push_back(back_ == nullptr ? BackBound::Sight{} : back_->sight(at));
  return mesh_.add_vertex(at);
}

bool DecimationState::permits(const MeshEdit& edit) {
  const Point before = edit.vertex == kNoIndex ? Point::Zero() : mesh_.position(edit.vertex);
  if (edit.vertex != kNoIndex) mesh_.move(edit.vertex, edit.position);
  const auto judge = [&] {
    if (back_ != nullptr && edit.vertex != kNoIndex) {
      moved_ = back_->sight_from(edit.position, sight_[edit.vertex].triangle);
      if (!(moved_.share <= 1)) moved_ = back_->sight(edit.position, moved_.triangle);
    }
    if (back_ != nullptr && !guards_.skip_back_bound) {
      if (edit.vertex != kNoIndex && !(moved_.share <= 1)) return false;
      for (const Triangle& t : edit.added) {
        // Seen from the vertex that moved, or any.
        std::size_t i = 0;
        if (edit.vertex != kNoIndex) {
          while (i < 2 && t[i] != edit.vertex) ++i;
        }
        const std::uint32_t near = t[i] == edit.vertex ? moved_.triangle : sight_[t[i]].triangle;
        const std::array<Point, 3> corners = {mesh_.position(t[i]), mesh_.position(t[(i + 1) % 3]),
                                              mesh_.position(t[(i + 2) % 3])};
        if (!back_->holds(corners, near)) return false;
      }
    }
    return guards_.skip_intersections || !(meets_itself(edit) || meets_another(edit));
  };
  const bool permitted = judge();
  if (edit.vertex != kNoIndex) mesh_.move(edit.vertex, before);
  return permitted;
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
  boxes_.clear();
  Bounds around;
  for (const Triangle& t : edit.added) {
    const std::array<Point, 3> corners = {mesh_.position(t[0]), mesh_.position(t[1]),
                                          mesh_.position(t[2])};
    boxes_.push_back(bounds_of(corners));
    around = boxes_.size() == 1 ? boxes_.front() : joined(around, boxes_.back());
  }
  return !tree_.for_each_overlap(around, [&](std::uint32_t slot, const Bounds& box) {
    if (std::find(edit.removed.begin(), edit.removed.end(), slot) != edit.removed.end()) {
      return true;
    }
    for (std::size_t i = 0; i < edit.added.size(); ++i) {
      if (!overlap(boxes_[i], box)) continue;
      const std::array<Triangle, 2> pair = {edit.added[i], mesh_.triangle(slot)};
      if (intersect_beyond_shared({mesh_.positions(), pair}, 0, 1)) return false;
    }
    return true;
  });
}

void DecimationState::apply(const MeshEdit& edit, EditUndo* undo) {
  if (undo != nullptr) {
    undo->slots.clear();
    undo->answers.clear();
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
  for (const std::uint32_t slot : edit.removed) mesh_.clear(slot);
  if (edit.vertex != kNoIndex) {
    mesh_.move(edit.vertex, edit.position);
    if (back_ != nullptr) sight_[edit.vertex] = moved_;
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
  assigned_.add_slots(mesh_.slots());
  for (const MeshEdit::Answer& a : edit.answers) {
    assigned_.assign(a.point, a.added == kNoIndex ? a.slot : placed_[a.added], a.squared_distance);
  }
  for (const std::uint32_t slot : edit.removed) changed(slot);
  for (std::size_t i = edit.removed.size(); i < placed_.size(); ++i) changed(placed_[i]);
  rebuild_when_coarser();
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
}

// Boxes grow looser as triangles go, and what was added is searched one by one.
void DecimationState::rebuild_when_coarser() {
  constexpr std::size_t kMostAdded = 128;
  if (2 * mesh_.triangles() < tree_.triangles_at_rebuild() || tree_.added() > kMostAdded) {
    tree_.rebuild(mesh_);
  }
}

}  // namespace emax
