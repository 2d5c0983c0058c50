#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace emax {

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// The perceptually uniform map "viridis" from dark blue at 0 to yellow at 1 and beyond.
Colour viridis(double position);

// The colours of deviations, in pictures as on the page of a report: equally spaced stops from
// -reach to reach, or from 0 where deviations have no sign, and what lies above and below.
struct DeviationScale {
  std::array<Colour, 9> stops;
  Colour above, below;
};

// From blue by way of light grey to red, or viridis. Both keep their order for every kind of colour
// vision. What lies beyond has a colour that the stops do not have.
const DeviationScale& deviation_scale(bool is_signed);

Colour deviation_colour(double deviation, double reach, bool is_signed);

// The colour of the n-th of many things that are told apart: hues by the golden angle, in three
// brightnesses.
Colour distinct_colour(std::size_t n);

}  // namespace emax
