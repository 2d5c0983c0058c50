#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace emax {

// The nearest rank, counted from 1: the smallest rank such that at least a share of `count`
// ascending values do not exceed the value of that rank. It is ceil(share * count), and 1 for a
// share of 0. `count` is positive, share in [0, 1].
inline std::size_t nearest_rank(double share, std::size_t count) {
  // The roundings of the share and of the product must not lift a whole rank to the next.
  const double rank = std::ceil(share * static_cast<double>(count) * (1 - 0x1p-50));
  return static_cast<std::size_t>(std::max(rank, 1.0));
}

}  // namespace emax
