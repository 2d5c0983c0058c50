#pragma once

#include <cstdint>

#include "testbench/stimuli/random.h"

namespace emax {

// A word of any kind: an ordinary number, a special value (zeros, subnormals, boundaries,
// infinities, NaNs) or random bits.
std::uint32_t any_word(Random& random);

}  // namespace emax
