#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace emax {

// Of 0 to size - 1, each a set of its own at first; the least of a set is its root. Nearly O(1) a
// call.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Whether they were apart.
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
