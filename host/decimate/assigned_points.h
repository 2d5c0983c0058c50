#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/decimate/editable_mesh.h"

namespace emax {

// The points of the cloud that each triangle answers for, with their squared distances to it: upper
// bounds of the distance to the mesh. A point is in the lists of one triangle or of none. Some
// points are guides, which have lists of their own: searches look at them alone, and only what they
// find is tested with the others.
class AssignedPoints {
 public:
  // About one of `every` points is a guide.
  AssignedPoints(std::size_t points, std::size_t slots, std::size_t every = 1)
      : owner_(points, kNoIndex),
        squared_(points, 0),
        next_(points, kNoIndex),
        previous_(points, kNoIndex),
        first_(slots, {kNoIndex, kNoIndex}) {
    if (every > 1) is_other_.resize(points, 1);
    // Scattered, so that no row or column of a scan is left out.
    constexpr std::uint32_t kScatter = 0x9E3779B1;  // 2^32 over the golden ratio
    for (std::uint32_t p = 0; p < is_other_.size(); ++p) {
      if ((p * kScatter >> 8) % every == 0) is_other_[p] = 0;
    }
  }

  bool all_are_guides() const { return is_other_.empty(); }
  bool is_guide(std::uint32_t point) const {
    return point >= is_other_.size() || is_other_[point] == 0;
  }
  void make_guide(std::uint32_t point) {
    if (is_guide(point)) return;
    const std::uint32_t slot = owner_[point];
    const double squared = squared_[point];
    assign(point, kNoIndex, squared);
    is_other_[point] = 0;
    assign(point, slot, squared);
  }
  // Takes its triangle from every point that has one and is no guide. reassign() of the state gives
  // them one again.
  void detach_others() {
    for (std::uint32_t p = 0; p < is_other_.size(); ++p) {
      if (is_other_[p] != 0 && owner_[p] != kNoIndex) assign(p, kNoIndex, kDetached);
    }
  }
  // Whether the point had a triangle that was taken from it.
  bool detached(std::uint32_t point) const { return squared_[point] == kDetached; }

  std::size_t size() const { return owner_.size(); }
  std::uint32_t owner(std::uint32_t point) const { return owner_[point]; }
  double squared_distance(std::uint32_t point) const { return squared_[point]; }
  // Belongs to no triangle at first. Returns its number.
  std::uint32_t add_point() {
    owner_.push_back(kNoIndex);
    squared_.push_back(0);
    next_.push_back(kNoIndex);
    previous_.push_back(kNoIndex);
    return static_cast<std::uint32_t>(owner_.size() - 1);
  }
  void add_slots(std::size_t slots) {
    if (slots > first_.size()) first_.resize(slots, {kNoIndex, kNoIndex});
  }

  // O(1). `slot` may be kNoIndex.
  void assign(std::uint32_t point, std::uint32_t slot, double squared_distance) {
    squared_[point] = squared_distance;
    if (owner_[point] == slot) return;
    const std::size_t list = is_guide(point) ? 0 : 1;
    if (owner_[point] != kNoIndex) {
      (previous_[point] == kNoIndex ? first_[owner_[point]][list] : next_[previous_[point]]) =
          next_[point];
      if (next_[point] != kNoIndex) previous_[next_[point]] = previous_[point];
    }
    owner_[point] = slot;
    previous_[point] = next_[point] = kNoIndex;
    if (slot == kNoIndex) return;
    std::uint32_t& first = first_[slot][list];
    next_[point] = first;
    if (first != kNoIndex) previous_[first] = point;
    first = point;
  }

  template <class Visit>
  void for_each(std::uint32_t slot, const Visit& visit) const {
    for_each_guide(slot, visit);
    for_each_other(slot, visit);
  }
  template <class Visit>
  void for_each_guide(std::uint32_t slot, const Visit& visit) const {
    for (std::uint32_t p = first_[slot][0]; p != kNoIndex; p = next_[p]) visit(p);
  }
  template <class Visit>
  void for_each_other(std::uint32_t slot, const Visit& visit) const {
    for (std::uint32_t p = first_[slot][1]; p != kNoIndex; p = next_[p]) visit(p);
  }

 private:
  static constexpr double kDetached = std::numeric_limits<double>::infinity();

  std::vector<char> is_other_;  // no guide; empty where all are guides
  std::vector<std::uint32_t> owner_;
  std::vector<double> squared_;
  std::vector<std::uint32_t> next_, previous_;       // of each point, in its list
  std::vector<std::array<std::uint32_t, 2>> first_;  // of each slot: of the guides, of the others
};

}  // namespace emax
