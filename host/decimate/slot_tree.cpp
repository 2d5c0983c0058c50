#include "host/decimate/slot_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace emax {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kInfinite = std::numeric_limits<float>::infinity();
// Subtracted from squared distances to boxes for the roundings of their binary32 arithmetic.
constexpr double kRoundings = 1e-6;

Bounds nothing() { return {Point::Constant(kInfinity), Point::Constant(-kInfinity)}; }

float rounded_down(double value) {
  const auto near = static_cast<float>(value);
  return static_cast<double>(near) > value ? std::nextafterf(near, -kInfinite) : near;
}
float rounded_up(double value) { return -rounded_down(-value); }

double to_segment(const Point& p, const Point& a, const Point& b) {
  const Point u = b - a;
  const double length = u.squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(u) / length, 0.0, 1.0) : 0;
  return (a + s * u - p).squaredNorm();
}

}  // namespace

// This is not the kernel's distance: here a triangle meets one point, and its frame would be made
// for that point alone. With frame_of() and the kernel in double, bunny00.off at 0.321% takes 8%
// more time.
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

SlotTree::Box SlotTree::rounded(const Bounds& box) const {
  Box result{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    result.lower[i] = rounded_down((box.lower[axis] - origin_[axis]) * scale_);
    result.upper[i] = rounded_up((box.upper[axis] - origin_[axis]) * scale_);
  }
  return result;
}

SlotTree::Box SlotTree::box_of(const Node& node) const {
  Box box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = *std::ranges::min_element(node.lower[axis]);
    box.upper[axis] = *std::ranges::max_element(node.upper[axis]);
  }
  return box;
}

SlotTree::Box SlotTree::box_of(const Node& node, std::size_t place) const {
  Box box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = node.lower[axis][place];
    box.upper[axis] = node.upper[axis][place];
  }
  return box;
}

void SlotTree::put(std::uint32_t place, std::uint32_t child, const Box& box) {
  Node& node = nodes_[place / kPlaces];
  const std::size_t i = place % kPlaces;
  node.child[i] = child;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.lower[axis][i] = box.lower[axis];
    node.upper[axis][i] = box.upper[axis];
  }
  if (child == kNoIndex) return;
  if ((child & kLeaf) != 0) {
    leaf_of_[child & ~kLeaf] = place;
  } else {
    nodes_[child].parent = place;
  }
}

std::uint32_t SlotTree::add_node(std::uint32_t parent) {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_.back().parent = parent;
  for (unsigned i = 0; i < kPlaces; ++i) put(kPlaces * node + i, kNoIndex, rounded(nothing()));
  return node;
}

void SlotTree::rebuild(const EditableMesh& mesh) {
  nodes_.clear();
  inserted_ = deepest_ = 0;
  leaf_of_.assign(mesh.slots(), kNoIndex);
  Bounds all = nothing();
  for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
    if (mesh.alive(slot)) all = joined(all, bounds_of(mesh.corners(slot)));
  }
  triangles_at_rebuild_ = mesh.triangles();
  origin_ = mesh.triangles() == 0 ? Point::Zero() : all.midpoint();
  const double width = mesh.triangles() == 0 ? 1 : all.width();
  scale_ = width > 0 ? std::ldexp(1.0, -std::ilogb(width)) : 1;
  std::vector<Item> items;
  items.reserve(mesh.triangles());
  for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
    if (mesh.alive(slot)) items.push_back({slot, rounded(bounds_of(mesh.corners(slot)))});
  }
  nodes_.reserve(items.size());
  add_node(kNoIndex);
  build(0, items);
}

namespace {

// Splits at the median of the boxes' centres along their longest extent. Returns its index.
template <class Items>
std::size_t halve(Items items) {
  using Axes = std::array<float, 3>;
  const auto twice_centre = [](const auto& item, std::size_t axis) {
    return item.box.lower[axis] + item.box.upper[axis];
  };
  Axes least{kInfinite, kInfinite, kInfinite}, most{-kInfinite, -kInfinite, -kInfinite};
  for (const auto& item : items) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], twice_centre(item, axis));
      most[axis] = std::max(most[axis], twice_centre(item, axis));
    }
  }
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (most[axis] - least[axis] > most[longest] - least[longest]) longest = axis;
  }
  const std::size_t middle = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                   [&](const auto& a, const auto& b) {
                     const float of_a = twice_centre(a, longest), of_b = twice_centre(b, longest);
                     return of_a != of_b ? of_a < of_b : a.slot < b.slot;
                   });
  return middle;
}

}  // namespace

void SlotTree::build(std::uint32_t node, std::span<Item> items) {
  std::array<std::span<Item>, kPlaces> parts;
  if (items.size() <= kPlaces) {
    for (std::size_t i = 0; i < items.size(); ++i) parts[i] = items.subspan(i, 1);
  } else {
    for (std::size_t half = 0; half < 2; ++half) {
      const std::size_t middle = half == 0 ? halve(items) : items.size() / 2;
      const std::span<Item> part = half == 0 ? items.first(middle) : items.subspan(middle);
      const std::size_t quarter = halve(part);
      parts[2 * half] = part.first(quarter);
      parts[2 * half + 1] = part.subspan(quarter);
    }
  }
  for (unsigned i = 0; i < kPlaces; ++i) {
    const std::uint32_t place = kPlaces * node + i;
    if (parts[i].size() > 1) {
      const std::uint32_t child = add_node(place);
      build(child, parts[i]);
      put(place, child, box_of(nodes_[child]));
    } else if (!parts[i].empty()) {
      put(place, parts[i][0].slot | kLeaf, parts[i][0].box);
    }
  }
}

void SlotTree::update(const EditableMesh& mesh, std::uint32_t slot) {
  if (slot >= leaf_of_.size()) leaf_of_.resize(mesh.slots(), kNoIndex);
  const std::uint32_t place = leaf_of_[slot];
  if (place == kNoIndex) {
    if (mesh.alive(slot)) insert(slot, rounded(bounds_of(mesh.corners(slot))));
    return;
  }
  put(place, slot | kLeaf, rounded(mesh.alive(slot) ? bounds_of(mesh.corners(slot)) : nothing()));
  refit(place / kPlaces);
}

void SlotTree::refit(std::uint32_t node) {
  for (std::uint32_t place = nodes_[node].parent; place != kNoIndex; place = nodes_[node].parent) {
    const Box box = box_of(nodes_[node]);
    node = place / kPlaces;
    const std::size_t i = place % kPlaces;
    bool same = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      same = same && nodes_[node].lower[axis][i] == box.lower[axis] &&
             nodes_[node].upper[axis][i] == box.upper[axis];
    }
    if (same) return;
    put(place, nodes_[node].child[i], box);
  }
}

// Inserts into the first free place on the path along which boxes grow least.
void SlotTree::insert(std::uint32_t slot, const Box& box) {
  ++inserted_;
  std::uint32_t node = 0;
  for (std::size_t depth = 1;; ++depth) {
    std::size_t best = 0;
    float least = kInfinite;
    bool free = false;
    for (std::size_t i = 0; i < kPlaces && !free; ++i) {
      free = nodes_[node].child[i] == kNoIndex;
      float growth = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float lower = nodes_[node].lower[axis][i], upper = nodes_[node].upper[axis][i];
        growth += std::max(lower - box.lower[axis], 0.0f) + std::max(box.upper[axis] - upper, 0.0f);
      }
      if (!free && !(growth < least)) continue;
      least = growth;
      best = i;
    }
    const auto place = static_cast<std::uint32_t>(kPlaces * node + best);
    const std::uint32_t child = nodes_[node].child[best];
    if (free) {
      put(place, slot | kLeaf, box);
      break;
    }
    if ((child & kLeaf) == 0) {
      node = child;
      continue;
    }
    const std::uint32_t added = add_node(place);
    put(kPlaces * added, child, box_of(nodes_[node], best));
    put(kPlaces * added + 1, slot | kLeaf, box);
    put(place, added, box_of(nodes_[added]));
    deepest_ = std::max(deepest_, depth + 1);
    break;
  }
  refit(node);
}

bool SlotTree::outgrown(const EditableMesh& mesh) const {
  constexpr std::size_t kFewInserted = 128;
  return 2 * mesh.triangles() < triangles_at_rebuild_ ||
         inserted_ > triangles_at_rebuild_ + kFewInserted || deepest_ >= kDeepest;
}

// The gap between the box and each place along an axis; not positive where they overlap.
SlotTree::Lanes SlotTree::gap(const Node& node, const Box& box, std::size_t axis) {
  const Eigen::Map<const Lanes, Eigen::Aligned16> lower(node.lower[axis].data());
  const Eigen::Map<const Lanes, Eigen::Aligned16> upper(node.upper[axis].data());
  return (lower - box.upper[axis]).max(box.lower[axis] - upper);
}

unsigned SlotTree::overlapping(const Node& node, const Box& box) {
  const Lanes most = gap(node, box, 0).max(gap(node, box, 1)).max(gap(node, box, 2));
  unsigned places = 0;
  for (unsigned i = 0; i < kPlaces; ++i) places |= (most[i] <= 0 ? 1u : 0u) << i;
  return places;
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
  const Box at = rounded({p, p});
  const double unit = (1 - kRoundings) / (scale_ * scale_);
  struct Entry {
    std::uint32_t child;
    float squared;
  };
  std::array<Entry, kStack> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, 0};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (static_cast<double>(entry.squared) * unit > best.squared_distance) continue;
    if ((entry.child & kLeaf) != 0) {
      try_slot(entry.child & ~kLeaf);
      continue;
    }
    const Node& node = nodes_[entry.child];
    Lanes squared = Lanes::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis) squared += gap(node, at, axis).max(0).square();
    // The nearest is pushed last, so that it is visited first.
    const std::size_t first = depth;
    for (unsigned i = 0; i < kPlaces; ++i) {
      if (node.child[i] == kNoIndex) continue;
      if (static_cast<double>(squared[i]) * unit > best.squared_distance) continue;
      std::size_t place = depth++;
      for (; place > first && stack[place - 1].squared < squared[i]; --place) {
        stack[place] = stack[place - 1];
      }
      stack[place] = {node.child[i], squared[i]};
    }
  }
  return best;
}

}  // namespace emax
