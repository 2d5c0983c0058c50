#pragma once

#include <Eigen/Core>
#include <string_view>

#include "host/picture/raster.h"

namespace emax {

// Draws numbers and units as lines: digits, signs, the decimal point, and the letters of exponents
// and of unit names. Other characters leave a gap. `at`: the left end of the line of text, at half
// the height of its digits; `height`: of digits, in samples.
void draw_text(Raster& raster, std::string_view text, const Eigen::Vector2d& at, double height,
               const Colour& colour);

}  // namespace emax
