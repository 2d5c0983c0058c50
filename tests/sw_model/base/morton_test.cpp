#include "sw_model/base/morton.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace emax
