#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace emax {

// Sets of the numbers 0 to size - 1. At first each number is a set of its own. The least number of
// a set is its root. Nearly O(1) a call.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Returns whether the two were in different sets.
  bool join(std::size_t i, std::size_t j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
    return i != j;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace emax
