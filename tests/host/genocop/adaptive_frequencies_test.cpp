#include "host/genocop/adaptive_frequencies.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

namespace emax {
namespace {

TEST(AdaptiveFrequencies, SumToOneAndKeepTheFloorWhateverHappens) {
  constexpr double kFloor = 0.3;
  const std::array<double, 5> initial = {1, 2, 0, 1, 4};
  AdaptiveFrequencies frequencies(initial, kFloor);
  RandomStream random(1, 0, RandomStream::Purpose::kTest);
  for (int i = 0; i < 2000; ++i) {
    const std::size_t entry = frequencies.draw(random);
    ASSERT_NE(entry, 2u);
    frequencies.reward(entry, entry == 1 || random.chance(0.1) ? 1 : 0);
    const auto& f = frequencies.frequencies();
    ASSERT_NEAR(std::accumulate(f.begin(), f.end(), 0.0), 1, 1e-12);
    for (std::size_t k = 0; k < f.size(); ++k) {
      if (initial[k] > 0) {
        ASSERT_GE(f[k], kFloor / 4 - 1e-12);
      } else {
        ASSERT_EQ(f[k], 0);
      }
    }
  }
  EXPECT_GT(frequencies.frequencies()[1], 0.5);  // the one that always succeeds
}

TEST(AdaptiveFrequencies, WithoutRewardsTheyAreTheGivenShares) {
  const std::array<double, 3> initial = {1, 2, 1};
  const AdaptiveFrequencies frequencies(initial, 0);
  EXPECT_NEAR(frequencies.frequencies()[0], 0.25, 1e-12);
  EXPECT_NEAR(frequencies.frequencies()[1], 0.5, 1e-12);
}

}  // namespace
}  // namespace emax
