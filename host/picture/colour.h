#pragma once

#include <array>
#include <cstdint>

namespace emax {

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// The perceptually uniform map "viridis" from dark blue at 0 to yellow at 1 and beyond.
Colour viridis(double position);

// The colours of deviations, in pictures as on the page of a report
// (host/report/page/src/scale.js): from blue at -reach by way of light grey to red at reach, or
// viridis where deviations have no sign. What lies beyond has a colour that the scale does not
// have.
Colour deviation_colour(double deviation, double reach, bool is_signed);

}  // namespace emax
