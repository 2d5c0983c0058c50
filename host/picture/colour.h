#pragma once

#include <array>
#include <cstdint>

namespace emax {

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// The perceptually uniform map "viridis" from dark blue at 0 to yellow at 1 and beyond.
Colour viridis(double position);

// Moreland's "cool to warm" (2009), which eyes of every kind tell apart: blue at -1 and beyond,
// light grey at 0, red at 1 and beyond.
Colour cool_to_warm(double position);

}  // namespace emax
