#include "host/genocop/ranking.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emax {
namespace {

// Pearson's statistic of draws against expected probabilities.
double chi_squared(const std::vector<int>& counts, const std::vector<double>& expected, int draws) {
  double sum = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double mean = expected[i] * draws;
    sum += (counts[i] - mean) * (counts[i] - mean) / mean;
  }
  return sum;
}

TEST(Ranking, DrawsFollowTheFormula) {
  constexpr std::uint64_t kSeed = 31;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  constexpr std::size_t kCount = 8;
  constexpr int kDraws = 40000;
  constexpr double kCritical = 24.3;  // 7 degrees of freedom, 0.999
  for (double q : {0.1, 0.4}) {
    std::vector<double> formula(kCount), other(kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto rank = static_cast<double>(i);
      formula[i] = q * std::pow(1 - q, rank) / (1 - std::pow(1 - q, kCount));
      const double wrong = q + 0.02;
      other[i] = wrong * std::pow(1 - wrong, rank) / (1 - std::pow(1 - wrong, kCount));
    }
    RandomStream random(kSeed, 0, RandomStream::Purpose::kTest);
    std::vector<int> counts(kCount);
    for (int i = 0; i < kDraws; ++i) ++counts[select(ranking_probabilities(kCount, q), random)];
    EXPECT_LT(chi_squared(counts, formula, kDraws), kCritical) << "q " << q;
    EXPECT_GT(chi_squared(counts, other, kDraws), kCritical) << "q " << q;  // a near miss is seen
  }
}

TEST(Ranking, ProbabilitiesSumToOneAndOneIndividualIsCertain) {
  double sum = 0;
  for (double p : ranking_probabilities(70, 0.1)) sum += p;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_NEAR(ranking_probabilities(1, 0.1)[0], 1, 1e-12);
}

TEST(Select, NeverDrawsAWeightOfZero) {
  RandomStream random(32, 0, RandomStream::Purpose::kTest);
  const std::vector<double> weights = {0, 2, 0, 1, 0};
  int third = 0;
  for (int i = 0; i < 30000; ++i) {
    const std::size_t drawn = select(weights, random);
    ASSERT_TRUE(drawn == 1 || drawn == 3);
    third += drawn == 3;
  }
  EXPECT_NEAR(third, 10000, 300);
}

}  // namespace
}  // namespace emax
