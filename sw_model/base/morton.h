#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

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

// A cube of 1024 cells on each axis has codes of 30 bits, which are sorted without comparisons.
constexpr std::uint32_t kMortonCells = 1024;

// The code of a cell of that cube.
std::uint32_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z);

struct MortonKey {
  std::uint32_t code, item;
};

// Sorts keys by their codes of 30 bits; equal ones stay in their order. The result is in `sorted`,
// which is as long; both are overwritten. O(n).
void sort_by_code(std::span<MortonKey> keys, std::span<MortonKey> sorted);

}  // namespace emax
