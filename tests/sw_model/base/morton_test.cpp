#include "sw_model/base/morton.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/stimuli.h"

namespace emax {
namespace {

std::uint64_t bit_by_bit(std::uint64_t cell) {
  std::uint64_t spread = 0;
  for (unsigned bit = 0; bit < 21; ++bit) spread |= (cell >> bit & 1) << (3 * bit);
  return spread;
}

TEST(Morton, SpreadsEachBitToEveryThirdPlace) {
  for (unsigned bit = 0; bit < 21; ++bit) {
    ASSERT_EQ(spread_bits(std::uint64_t{1} << bit), std::uint64_t{1} << (3 * bit)) << bit;
  }
  test::Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const std::uint64_t cell = random.word() & 0x1fffff;
    ASSERT_EQ(spread_bits(cell), bit_by_bit(cell)) << "seed 1, cell " << cell;
  }
}

TEST(Morton, LeavesOutWhatIsBeyondTwentyOneBits) {
  EXPECT_EQ(spread_bits(std::uint64_t{1} << 21), 0u);
  EXPECT_EQ(spread_bits(~std::uint64_t{0}), spread_bits(0x1fffff));
}

TEST(Morton, SortsByCodesOfThirtyBitsAndKeepsEqualOnesInTheirOrder) {
  test::Random random(2);
  std::vector<MortonKey> keys(5000), sorted(keys.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    const auto cell = [&] {
      return static_cast<std::uint32_t>(random.word() % (i % 2 == 0 ? 5 : 1024));
    };
    const std::uint32_t x = cell(), y = cell(), z = cell();
    keys[i] = {morton_code(x, y, z), i};
    ASSERT_EQ(keys[i].code, spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z));
  }
  std::vector<MortonKey> expected = keys;
  std::ranges::stable_sort(expected, {}, &MortonKey::code);
  sort_by_code(keys, sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    ASSERT_EQ(sorted[i].code, expected[i].code) << "seed 2, " << i;
    ASSERT_EQ(sorted[i].item, expected[i].item) << "seed 2, " << i;
  }
}

}  // namespace
}  // namespace emax
