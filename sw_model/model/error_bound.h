#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "sw_model/base/float_bits.h"

namespace emax {

// How far the kernel's distance d_k (the square root of its d^2) can be from the true distance d of
// the point it was given to the triangle its record was made from, in normalised units:
//
//   |d_k - d| <= kKappa (|P - V1| + L1 + |V1|) + kDistanceFloor
//
// Proof in docs/numerics.md; tests/sw_model/model/error_bound_test.cpp searches for a
// counterexample.
constexpr double kKappa = 0x1p-19;
static_assert(27 * 0x1p-24 <= kKappa * 7 / 8, "27 u are proven, an eighth is kept for roundings");
constexpr double kDistanceFloor = 0x1p-62;  // squares flush below 2^-126

// A triangle at least `lower_bound` away, of diameter (longest edge) at most `diameter` and with
// |V1| at most `max_vertex`, has a kernel distance of at least lower_bound minus this: a search may
// skip it only where lower_bound - margin > sqrt(best d^2). The bound itself may carry a relative
// rounding of 2^-40.
inline double kernel_distance_margin(double lower_bound, double diameter, double max_vertex) {
  return kKappa * (lower_bound + diameter + max_vertex) + kDistanceFloor;
}

// The greatest kernel e_max^2, as bits, that proves e_max <= epsilon for the cloud before it was
// rounded to binary32; nothing where even 0 does not prove it. `max_reach` is at least
// epsilon + 2 * longest edge + greatest |vertex|. Both arguments are in normalised units, positive
// and finite.
inline std::optional<std::uint32_t> largest_feasible_bits(double epsilon, double max_reach) {
  const double allowed = epsilon - (kKappa * max_reach + kDistanceFloor);
  if (!(allowed >= 0)) return std::nullopt;
  // The proof leaves an eighth of kKappa unused, which covers the roundings of `allowed`.
  const double squared = std::nextafter(allowed * allowed, 0.0);
  if (squared >= static_cast<double>(std::numeric_limits<float>::max())) {
    return float_bits(std::numeric_limits<float>::max());
  }
  const float nearest = static_cast<float>(squared);
  const std::uint32_t bits = float_bits(nearest);
  return static_cast<double>(nearest) > squared ? bits - 1 : bits;
}

}  // namespace emax
