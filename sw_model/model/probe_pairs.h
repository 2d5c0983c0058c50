#pragma once

#include <cmath>
#include <cstdint>

#include "hls/kernel/triangle_record.h"

namespace emax {

// Records and points for self-tests, always the same: coordinates in [-1, 1) that use all digits,
// so that every rounding shows in the bits of a distance. Of no triangle in particular.
class ProbePairs {
 public:
  TriangleRecord<float> record() {
    return {{next(), next(), next()},
            {next(), next(), next()},
            {next(), next(), next()},
            {next(), next(), next()},
            std::abs(next()),
            {{next(), next()}, std::abs(next())},
            {{next(), next()}, std::abs(next())},
            0};
  }
  Vector3<float> point() { return {next(), next(), next()}; }
  std::uint32_t word() { return state_ = state_ * 1664525u + 1013904223u; }

 private:
  float next() { return static_cast<float>(word() >> 8) * 0x1p-23f - 1.0f; }

  std::uint32_t state_ = 0x2545f491;
};

}  // namespace emax
