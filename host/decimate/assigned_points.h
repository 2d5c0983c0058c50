#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/decimate/editable_mesh.h"

namespace emax {

// The points of the cloud that each triangle answers for, with their squared distances to it: upper
// bounds of the distance to the mesh. A point is in the list of one triangle or of none.
class AssignedPoints {
 public:
  AssignedPoints(std::size_t points, std::size_t slots)
      : owner_(points, kNoIndex),
        squared_(points, 0),
        next_(points, kNoIndex),
        previous_(points, kNoIndex),
        first_(slots, kNoIndex) {}

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
    if (slots > first_.size()) first_.resize(slots, kNoIndex);
  }

  // O(1). `slot` may be kNoIndex.
  void assign(std::uint32_t point, std::uint32_t slot, double squared_distance) {
    squared_[point] = squared_distance;
    if (owner_[point] == slot) return;
    if (owner_[point] != kNoIndex) {
      (previous_[point] == kNoIndex ? first_[owner_[point]] : next_[previous_[point]]) =
          next_[point];
      if (next_[point] != kNoIndex) previous_[next_[point]] = previous_[point];
    }
    owner_[point] = slot;
    previous_[point] = next_[point] = kNoIndex;
    if (slot == kNoIndex) return;
    next_[point] = first_[slot];
    if (first_[slot] != kNoIndex) previous_[first_[slot]] = point;
    first_[slot] = point;
  }

  template <class Visit>
  void for_each(std::uint32_t slot, const Visit& visit) const {
    for (std::uint32_t p = first_[slot]; p != kNoIndex; p = next_[p]) visit(p);
  }

 private:
  std::vector<std::uint32_t> owner_;
  std::vector<double> squared_;
  std::vector<std::uint32_t> next_, previous_;  // of each point, in its list
  std::vector<std::uint32_t> first_;            // of each slot
};

}  // namespace emax
