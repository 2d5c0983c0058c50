#include "host/report/deviation_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace emax {
namespace {

TEST(DeviationStatistics, OfFiveNumbers) {
  const std::vector<double> d = {-3, -1, 0, 1, 8};
  const DeviationStatistics s = deviation_statistics(d, 1);
  EXPECT_EQ(s.count, 5u);
  EXPECT_EQ(s.min, -3);
  EXPECT_EQ(s.max, 8);
  EXPECT_DOUBLE_EQ(s.mean, 1);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(15));
  EXPECT_DOUBLE_EQ(s.sigma, std::sqrt(14));
  EXPECT_DOUBLE_EQ(s.within_sigma[0], 0.6);  // within 1 +- 3.74: -1, 0 and 1
  EXPECT_DOUBLE_EQ(s.within_sigma[1], 1);
  EXPECT_EQ(s.against_epsilon, (std::array<std::size_t, 3>{1, 3, 1}));  // the ends are within
  EXPECT_FALSE(deviation_statistics(d, std::nullopt).against_epsilon);
}

TEST(DeviationHistogram, CountsEveryDeviationOnce) {
  const std::vector<double> d = {-2.01, -2, -0.05, 0, 0.15, 1.999, 2, 2.01, 90};
  const DeviationHistogram h = deviation_histogram(d, true, 2);
  EXPECT_EQ(h.edges.size(), h.counts.size() + 1);
  EXPECT_EQ(h.edges.front(), -2);
  EXPECT_EQ(h.edges[h.counts.size() / 2], 0);
  EXPECT_EQ(h.edges.back(), 2);
  EXPECT_EQ(h.below, 1u);
  EXPECT_EQ(h.above, 2u);
  EXPECT_EQ(h.counts.front(), 1u);
  EXPECT_EQ(h.counts.back(), 2u);  // 2 itself is in the last bin
  EXPECT_EQ(h.counts[h.counts.size() / 2 - 1], 1u);
  EXPECT_EQ(h.counts[h.counts.size() / 2], 1u);  // 0 belongs to the upper one
  EXPECT_EQ(h.counts[h.counts.size() / 2 + 1], 1u);
  EXPECT_EQ(std::accumulate(h.counts.begin(), h.counts.end(), std::size_t{0}), 6u);

  const DeviationHistogram distances = deviation_histogram(std::vector<double>{0, 1, 3}, false, 2);
  EXPECT_EQ(distances.edges.front(), 0);
  EXPECT_EQ(distances.below, 0u);
  EXPECT_EQ(distances.above, 1u);
}

}  // namespace
}  // namespace emax
