#include "host/report/error_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/engine/nearest_rank.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(ErrorStatistics, OfAFewNumbersByHand) {
  const std::vector<double> distances = {3, 0, 4, 1};
  const std::vector<double> percents = {25, 50, 51, 100, 0};
  const ErrorStatistics s = statistics_of(distances, percents, 1.0);
  EXPECT_EQ(s.count, 4u);
  EXPECT_EQ(s.maximum, 4);
  EXPECT_EQ(s.mean, 2);
  EXPECT_EQ(s.rms, std::sqrt(26.0 / 4));
  EXPECT_EQ(s.exceeding, 2u);
  std::vector<double> values;
  for (const auto& quantile : s.quantiles) values.push_back(quantile.value);
  EXPECT_EQ(values, (std::vector<double>{0, 1, 3, 4, 0}));
}

TEST(ErrorStatistics, HistogramHoldsOutliersInItsLastBin) {
  // 0 to 1499 and an outlier: 99.9 % of 1501 are 1500.
  std::vector<double> distances(1500);
  std::iota(distances.begin(), distances.end(), 0.0);
  distances.push_back(1e6);
  const auto bins = statistics_of(distances, kUsualQuantiles).histogram;
  ASSERT_EQ(bins.size(), kHistogramBins);
  for (std::size_t i = 0; i + 1 < bins.size(); ++i) {
    EXPECT_NEAR(bins[i].up_to, 1499.0 * static_cast<double>(i + 1) / 15, 1e-9);
    EXPECT_EQ(bins[i].count, 100u) << i;
  }
  EXPECT_EQ(bins.back().up_to, 1e6);
  EXPECT_EQ(bins.back().count, 1u);
}

TEST(ErrorStatistics, KeepsItsOrderWithManyAndWithEqualNumbers) {
  test::Random random(301);
  std::vector<double> distances(5000);
  for (double& d : distances) d = random.uniform(0, 1) < 0.1 ? 0.25 : random.uniform(0, 2);
  const ErrorStatistics s = statistics_of(distances, kUsualQuantiles, 0.25);
  double below = -1;
  for (const auto& bin : s.histogram) {
    EXPECT_EQ(bin.count, static_cast<std::size_t>(std::ranges::count_if(
                             distances, [&](double d) { return d > below && d <= bin.up_to; })));
    below = bin.up_to;
  }
  EXPECT_EQ(below, s.maximum);
  EXPECT_LE(s.mean, s.rms);
  EXPECT_LE(s.rms, s.maximum);
  for (std::size_t i = 1; i < s.quantiles.size(); ++i) {
    EXPECT_LE(s.quantiles[i - 1].value, s.quantiles[i].value);
  }
  EXPECT_EQ(s.exceeding, static_cast<std::size_t>(
                             std::ranges::count_if(distances, [](double d) { return d > 0.25; })));

  const std::vector<double> zeros(7, -0.0);
  const ErrorStatistics none = statistics_of(zeros, kUsualQuantiles, 0.0);
  EXPECT_EQ(none.maximum, 0);
  EXPECT_EQ(none.exceeding, 0u);
  EXPECT_EQ(none.histogram.front().count, 7u);
}

// Against sorting all of them.
TEST(ErrorStatistics, QuantilesAreThoseOfTheSortedDistances) {
  test::Random random(302);
  std::vector<double> distances(3001);
  for (double& d : distances) {
    d = random.uniform(0, 1) < 0.3 ? 1 + 1e-15 * random.uniform(0, 100)
                                   : std::exp(random.uniform(-700, 700));
  }
  std::vector<double> percents;
  for (int i = 0; i <= 1000; ++i) percents.push_back(i / 10.0);
  const ErrorStatistics whole = statistics_of(distances, percents);
  const ErrorStatistics pieces = statistics_of(
      [&](const auto& take) {
        const std::span<const double> all = distances;
        take(all.first(1));
        take(all.subspan(1, 2000));
        take(all.subspan(2001));
      },
      percents);
  std::vector<double> sorted = distances;
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < percents.size(); ++i) {
    const std::size_t rank = nearest_rank(percents[i] / 100, sorted.size());
    EXPECT_EQ(whole.quantiles[i].value, sorted[rank - 1]) << percents[i];
    EXPECT_EQ(pieces.quantiles[i].value, sorted[rank - 1]) << percents[i];
  }
  EXPECT_EQ(pieces.mean, whole.mean);
  EXPECT_EQ(pieces.rms, whole.rms);
}

}  // namespace
}  // namespace emax
