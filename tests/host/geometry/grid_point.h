#pragma once

#include "tests/support/stimuli.h"

namespace emax::test {

// A point of whole coordinates from 0 to below `end`.
inline Point grid_point(Random& random, std::uint32_t end) {
  Point point;
  for (int k = 0; k < 3; ++k) point[k] = random.below(end);
  return point;
}

}  // namespace emax::test
