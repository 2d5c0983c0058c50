#pragma once

#include <limits>

namespace emax {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kUnitRoundoff = 0x1p-53;  // the relative error of one rounding

}  // namespace emax
