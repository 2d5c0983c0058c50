#include "host/app/decimation_progress.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

std::vector<double> shares(const std::vector<double>& guesses) {
  RisingShare share;
  std::vector<double> shown;
  for (const double guess : guesses) shown.push_back(share.next(guess));
  return shown;
}

TEST(RisingShare, FollowsAGuessThatRises) {
  const std::vector<double> shown = shares({0, 0.2, 0.4, 0.8, 1});
  for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_GT(shown[i], shown[i - 1] + 0.1);
  EXPECT_EQ(shown.front(), 0);
  EXPECT_GT(shown.back(), 0.9);
  EXPECT_LT(shown.back(), 1);
}

TEST(RisingShare, GoesOnFromWhereItWasWhenTheWorkBeginsAgain) {
  const std::vector<double> shown = shares({0, 0.5, 1, 0, 0.5, 1, 0, 0.5, 1});
  for (std::size_t i = 1; i < shown.size(); ++i) {
    // What a new work begins with is what the last one ended with.
    EXPECT_GE(shown[i], shown[i - 1]) << i;
    if (i % 3 != 0) {
      EXPECT_GT(shown[i], shown[i - 1]) << i;
    }
  }
  EXPECT_LT(shown.back(), 1);
}

TEST(RisingShare, StandsStillWhereAGuessFallsALittle) {
  const std::vector<double> shown = shares({0.5, 0.48, 0.49, 0.52});
  EXPECT_EQ(shown[1], shown[0]);
  EXPECT_EQ(shown[2], shown[0]);
  EXPECT_GT(shown[3], shown[0]);
}

TEST(RisingShare, OfThisWorkBeginsAtNothing) {
  RisingShare share;
  share.next(0.9);
  EXPECT_FALSE(share.began_again());
  EXPECT_NEAR(share.of_this_work(), 0.9, 1e-12);
  share.next(0.2);
  EXPECT_TRUE(share.began_again());
  EXPECT_EQ(share.of_this_work(), 0);
  share.next(0.6);
  EXPECT_FALSE(share.began_again());
  EXPECT_NEAR(share.of_this_work(), 0.5, 1e-12);
}

// Whatever the guesses are, even outside of 0 to 1.
TEST(RisingShare, NeverFallsAndNeverEnds) {
  constexpr std::uint64_t kSeed = 5;
  Random random(kSeed);
  RisingShare share;
  double last = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double shown = share.next(random.below(1'300) / 1000.0 - 0.1);
    ASSERT_GE(shown, last) << "guess " << i << ", seed " << kSeed;
    ASSERT_LE(shown, 1);
    last = shown;
  }
}

}  // namespace
}  // namespace emax::test
