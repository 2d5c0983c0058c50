#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "sw_model/base/mesh_view.h"

namespace emax::test {

// Metres of a step of the coordinates in LAS and E57.
inline constexpr double kStep = 1e-5;
using Steps = std::array<std::int32_t, 3>;

inline Steps in_steps(const Point& p) {
  const auto rounded = [](double x) { return static_cast<std::int32_t>(std::lround(x / kStep)); };
  return {rounded(p[0]), rounded(p[1]), rounded(p[2])};
}

}  // namespace emax::test
