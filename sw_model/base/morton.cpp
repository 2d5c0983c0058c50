#include "sw_model/base/morton.h"

#include <array>
#include <utility>

namespace emax {
namespace {

// spread_bits() of every value of ten bits.
constexpr auto kSpread = [] {
  std::array<std::uint32_t, kMortonCells> table{};
  for (std::uint32_t value = 0; value < kMortonCells; ++value) {
    table[value] = static_cast<std::uint32_t>(spread_bits(value));
  }
  return table;
}();

}  // namespace

std::uint32_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return kSpread[x] << 2 | kSpread[y] << 1 | kSpread[z];
}

// By the least significant digit first.
void sort_by_code(std::span<MortonKey> keys, std::span<MortonKey> sorted) {
  constexpr int kDigitBits = 10, kDigits = 3;
  constexpr std::uint32_t kValues = 1u << kDigitBits;
  static_assert(kDigits % 2 == 1, "the last pass ends in `sorted`");
  const auto digit = [](const MortonKey& key, int d) {
    return key.code >> (kDigitBits * d) & (kValues - 1);
  };
  std::array<std::array<std::uint32_t, kValues>, kDigits> starts{};
  for (const MortonKey& key : keys) {
    for (int d = 0; d < kDigits; ++d) ++starts[static_cast<std::size_t>(d)][digit(key, d)];
  }
  for (int d = 0; d < kDigits; ++d) {
    auto& start = starts[static_cast<std::size_t>(d)];
    std::uint32_t sum = 0;
    for (std::uint32_t& value : start) sum += std::exchange(value, sum);
    for (const MortonKey& key : keys) sorted[start[digit(key, d)]++] = key;
    std::swap(keys, sorted);
  }
}

}  // namespace emax
