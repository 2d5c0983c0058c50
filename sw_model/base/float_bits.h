#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>

namespace emax {

// The one place that knows the bits of a binary32: its fields, its classes, how it is printed. Bit
// patterns are compared as words, so -0 differs from +0 and a NaN equals itself.
constexpr std::uint32_t kSignBit = 0x80000000u;
constexpr std::uint32_t kFractionMask = 0x007fffffu;
constexpr std::uint32_t kExponentMask = 0x7f800000u;
constexpr std::uint32_t kCanonicalNan = 0x7fc00000u;
constexpr std::uint32_t kSmallestNormal = 0x00800000u;

constexpr std::uint32_t float_bits(float value) { return std::bit_cast<std::uint32_t>(value); }
constexpr float bits_float(std::uint32_t bits) { return std::bit_cast<float>(bits); }

constexpr bool is_nan_bits(std::uint32_t bits) { return (bits & ~kSignBit) > kExponentMask; }
constexpr bool is_subnormal_bits(std::uint32_t bits) {
  return (bits & kExponentMask) == 0 && (bits & kFractionMask) != 0;
}
constexpr bool is_finite_bits(std::uint32_t bits) {
  return (bits & kExponentMask) != kExponentMask;
}

// "0x3f800000 = 0/01111111/00000000000000000000000 = 1": word, sign/exponent/fraction, value.
inline std::string describe_bits(std::uint32_t bits) {
  std::string fields = std::to_string(bits >> 31) + "/";
  for (int bit = 30; bit >= 0; --bit) {
    fields += ((bits >> bit) & 1u) != 0 ? '1' : '0';
    if (bit == 23) fields += '/';
  }
  char text[96];
  std::snprintf(text, sizeof text, "0x%08x = %s = %.9g", static_cast<unsigned>(bits),
                fields.c_str(), static_cast<double>(bits_float(bits)));
  return text;
}

}  // namespace emax
