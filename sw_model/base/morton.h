#pragma once

#include <cstdint>

namespace emax {

// The lowest 21 bits of a cell's number, each three places from the next: what one axis gives to a
// Morton code.
constexpr std::uint64_t spread_bits(std::uint64_t cell) {
  cell &= 0x1fffff;
  cell = (cell | cell << 32) & 0x001f00000000ffff;
  cell = (cell | cell << 16) & 0x001f0000ff0000ff;
  cell = (cell | cell << 8) & 0x100f00f00f00f00f;
  cell = (cell | cell << 4) & 0x10c30c30c30c30c3;
  return (cell | cell << 2) & 0x1249249249249249;
}

}  // namespace emax
