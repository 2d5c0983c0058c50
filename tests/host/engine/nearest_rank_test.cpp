#include "host/engine/nearest_rank.h"

#include <gtest/gtest.h>

namespace emax {
namespace {

// Counted in whole numbers of thousandths of a percent, free of rounding.
TEST(NearestRank, EqualsCounting) {
  for (std::size_t n = 1; n < 2200; n += n < 40 ? 1 : 137) {
    for (std::size_t thousandths = 0; thousandths <= 100000; thousandths += 50) {
      const std::size_t rank = std::max<std::size_t>((thousandths * n + 99999) / 100000, 1);
      ASSERT_EQ(nearest_rank(static_cast<double>(thousandths) / 1000 / 100, n), rank)
          << thousandths << "/1000 % of " << n;
    }
  }
}

// 0.07 * 100 is above 7 in binary64.
TEST(NearestRank, RoundingOfTheProductIsNoRank) {
  EXPECT_GT(0.07 * 100, 7.0);
  EXPECT_EQ(nearest_rank(0.07, 100), 7u);
  EXPECT_EQ(nearest_rank(1, 1'000'000'007), 1'000'000'007u);
}

}  // namespace
}  // namespace emax
