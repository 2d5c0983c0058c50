#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "hls/kernel/triangle_record.h"
#include "sw_model/base/float_bits.h"

namespace emax {

// What every engine gives, bit for bit: the maximum over all points of the minimum over all
// triangles of the kernel's squared distance, and the lowest index of a point that attains it.
struct EmaxResult {
  std::uint32_t squared_bits;  // binary32, normalised units
  std::uint32_t worst_point;

  bool operator==(const EmaxResult&) const = default;
};

// The golden model: every pair on the flushing scalar, without any culling. O(points * triangles).
// Throws std::invalid_argument for no points or no triangles.
std::vector<std::uint32_t> nearest_squared_bits(std::span<const Vector3<float>> points,
                                                std::span<const TriangleRecord<float>> records);
EmaxResult worst_of(std::span<const std::uint32_t> squared_bits);
EmaxResult emax_model(std::span<const Vector3<float>> points,
                      std::span<const TriangleRecord<float>> records);

// The distance of a squared distance, in normalised units.
inline double distance_of(std::uint32_t squared_bits) {
  return std::sqrt(static_cast<double>(bits_float(squared_bits)));
}

// The kernel's squared distance of one pair on the flushing scalar.
[[gnu::visibility("default")]] std::uint32_t pair_squared_bits(const Vector3<float>& point,
                                                               const TriangleRecord<float>& record);

}  // namespace emax
