#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace emax {

// Sets of the numbers 0 to size - 1. At first each number is a set of its own. The least number of
// a set is its root. Nearly O(1) a call. Four bytes a number.
class DisjointSets {
 public:
  // Throws std::length_error for more than 2^32 numbers.
  explicit DisjointSets(std::size_t size) { grow(size); }
  std::size_t size() const { return parent_.size(); }
  void clear() { parent_.clear(); }
  // Adds the numbers up to `size` - 1, if there are fewer, as sets of their own. Throws as above.
  void grow(std::size_t size) {
    if (size > std::size_t{1} << 32) throw std::length_error("more than 2^32 numbers in sets");
    const std::size_t before = parent_.size();
    if (size <= before) return;
    parent_.resize(size);
    std::iota(parent_.begin() + static_cast<std::ptrdiff_t>(before), parent_.end(),
              static_cast<std::uint32_t>(before));
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Returns whether the two were in different sets.
  bool join(std::size_t i, std::size_t j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = static_cast<std::uint32_t>(std::min(i, j));
    return i != j;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace emax
