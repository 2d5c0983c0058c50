#include "host/decimate/slot_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace emax {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Bounds nothing() { return {Point::Constant(kInfinity), Point::Constant(-kInfinity)}; }

Bounds box_of(const EditableMesh& mesh, std::uint32_t slot) {
  return mesh.alive(slot) ? bounds_of(mesh.corners(slot)) : nothing();
}

double squared_distance(const Point& p, const Bounds& box) {
  return (p.cwiseMax(box.lower).cwiseMin(box.upper) - p).squaredNorm();
}

double to_segment(const Point& p, const Point& a, const Point& b) {
  const Point u = b - a;
  const double length = u.squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(u) / length, 0.0, 1.0) : 0;
  return (a + s * u - p).squaredNorm();
}

}  // namespace

double squared_distance(const Point& p, const std::array<Point, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Point n = (b - a).cross(c - a);
  const double area = n.squaredNorm();
  if (area > 0 && (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 &&
      (a - c).cross(p - c).dot(n) >= 0) {
    const double height = (p - a).dot(n);
    return height * height / area;
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

void SlotTree::rebuild(const EditableMesh& mesh) {
  nodes_.clear();
  added_.clear();
  leaf_of_.assign(mesh.slots(), kNoIndex);
  boxes_.assign(mesh.slots(), nothing());
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
    boxes_[slot] = box_of(mesh, slot);
    if (mesh.alive(slot)) slots.push_back(slot);
  }
  triangles_at_rebuild_ = slots.size();
  nodes_.reserve(2 * slots.size());
  if (!slots.empty()) build(slots, 0, slots.size());
}

std::uint32_t SlotTree::build(std::vector<std::uint32_t>& slots, std::size_t begin,
                              std::size_t end) {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  if (end - begin == 1) {
    nodes_[node].left = slots[begin];
    nodes_[node].box = boxes_[slots[begin]];
    leaf_of_[slots[begin]] = node;
    return node;
  }
  Bounds centres = nothing();
  for (std::size_t i = begin; i < end; ++i) {
    const Point centre = boxes_[slots[i]].midpoint();
    centres = joined(centres, {centre, centre});
  }
  int axis = 0;
  (centres.upper - centres.lower).maxCoeff(&axis);
  const auto at = [&](std::size_t i) { return slots.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const double of_a = boxes_[a].lower[axis] + boxes_[a].upper[axis];
    const double of_b = boxes_[b].lower[axis] + boxes_[b].upper[axis];
    return of_a != of_b ? of_a < of_b : a < b;
  });
  const std::uint32_t left = build(slots, begin, middle);
  const std::uint32_t right = build(slots, middle, end);
  nodes_[left].parent = nodes_[right].parent = node;
  nodes_[node].left = left;
  nodes_[node].right = right;
  nodes_[node].box = joined(nodes_[left].box, nodes_[right].box);
  return node;
}

void SlotTree::update(const EditableMesh& mesh, std::uint32_t slot) {
  if (slot >= leaf_of_.size()) {
    leaf_of_.resize(mesh.slots(), kNoIndex);
    boxes_.resize(mesh.slots(), nothing());
  }
  boxes_[slot] = box_of(mesh, slot);
  std::uint32_t node = leaf_of_[slot];
  if (node == kNoIndex) {
    if (std::find(added_.begin(), added_.end(), slot) == added_.end()) added_.push_back(slot);
    return;
  }
  nodes_[node].box = boxes_[slot];
  while ((node = nodes_[node].parent) != kNoIndex) {
    const Bounds box = joined(nodes_[nodes_[node].left].box, nodes_[nodes_[node].right].box);
    if (box.lower == nodes_[node].box.lower && box.upper == nodes_[node].box.upper) break;
    nodes_[node].box = box;
  }
}

SlotTree::Nearest SlotTree::nearest(const EditableMesh& mesh, const Point& p, double squared_bound,
                                    std::uint32_t hint) const {
  Nearest best{kNoIndex, squared_bound};
  const auto try_slot = [&](std::uint32_t slot) {
    if (!mesh.alive(slot)) return;
    const double squared = emax::squared_distance(p, mesh.corners(slot));
    if (squared < best.squared_distance ||
        (squared == best.squared_distance && slot < best.slot && best.slot != kNoIndex)) {
      best = {slot, squared};
    }
  };
  if (hint != kNoIndex) try_slot(hint);
  for (const std::uint32_t slot : added_) try_slot(slot);
  if (nodes_.empty()) return best;
  struct Entry {
    std::uint32_t node;
    double squared;
  };
  Entry stack[128];
  std::size_t depth = 0;
  stack[depth++] = {0, squared_distance(p, nodes_[0].box)};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.squared > best.squared_distance) continue;
    const Node& node = nodes_[entry.node];
    if (node.right == kNoIndex) {
      try_slot(node.left);
      continue;
    }
    Entry near{node.left, squared_distance(p, nodes_[node.left].box)};
    Entry far{node.right, squared_distance(p, nodes_[node.right].box)};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared <= best.squared_distance) stack[depth++] = far;
    if (near.squared <= best.squared_distance) stack[depth++] = near;
  }
  return best;
}

}  // namespace emax
