#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace emax {

// The rank, from 1, of the least of `count` ascending values that at least a share of them do not
// exceed: ceil(share * count), and 1 for a share of 0. `count` is positive, share in [0, 1].
inline std::size_t nearest_rank(double share, std::size_t count) {
  // What the share and the product were rounded by must not carry a whole rank over to the next.
  const double rank = std::ceil(share * static_cast<double>(count) * (1 - 0x1p-50));
  return static_cast<std::size_t>(std::max(rank, 1.0));
}

}  // namespace emax
