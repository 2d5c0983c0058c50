#include "host/genocop/sobol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

namespace emax {
namespace {

TEST(Sobol, EveryDimensionHasOnePointInEachSlice) {
  constexpr std::uint32_t kCount = 64;
  for (std::uint32_t first : {0u, 64u, 192u}) {
    std::vector<std::set<int>> slices(kSobolDimensions);
    for (std::uint32_t i = first; i < first + kCount; ++i) {
      const std::vector<double> point = sobol_point(5, i, kSobolDimensions);
      for (std::size_t d = 0; d < point.size(); ++d) {
        ASSERT_TRUE(point[d] > 0 && point[d] < 1);
        slices[d].insert(static_cast<int>(point[d] * kCount));
      }
    }
    for (std::size_t d = 0; d < kSobolDimensions; ++d) EXPECT_EQ(slices[d].size(), kCount) << d;
  }
}

// The first two dimensions are a (0, 2)-sequence: one point in each box of area 1/64, whatever its
// shape. A wrong direction number would put two into one.
TEST(Sobol, TheFirstTwoDimensionsFillEveryBox) {
  for (int wide : {1, 2, 4, 8, 16, 32, 64}) {
    const int high = 64 / wide;
    std::set<std::pair<int, int>> boxes;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const auto p = sobol_point(6, i, 2);
      boxes.emplace(static_cast<int>(p[0] * wide), static_cast<int>(p[1] * high));
    }
    EXPECT_EQ(boxes.size(), 64u) << wide;
  }
}

// The points that every description of the sequence begins with, in the order of Gray's code; the
// shift falls out of the differences of bits.
TEST(Sobol, FirstPointsAreThePublishedOnes) {
  const auto bits = [](double x) { return static_cast<std::uint32_t>(std::ldexp(x, 32)); };
  constexpr double kPublished[][4] = {{0.5, 0.5, 0.5, 0.5},
                                      {0.75, 0.25, 0.25, 0.25},
                                      {0.25, 0.75, 0.75, 0.75},
                                      {0.375, 0.375, 0.625, 0.875}};
  const auto zero = sobol_point(7, 0, 4);
  for (std::uint32_t i = 1; i <= 4; ++i) {
    const auto point = sobol_point(7, i ^ (i >> 1), 4);
    for (std::size_t d = 0; d < 4; ++d) {
      EXPECT_EQ(bits(point[d]) ^ bits(zero[d]), bits(kPublished[i - 1][d])) << i << ", " << d;
    }
  }
}

TEST(Sobol, SeedsShiftAndFurtherDimensionsAreRandom) {
  EXPECT_NE(sobol_point(1, 3, 2), sobol_point(2, 3, 2));
  const auto a = sobol_point(1, 3, kSobolDimensions + 3);
  EXPECT_EQ(a, sobol_point(1, 3, kSobolDimensions + 3));
  EXPECT_NE(a.back(), sobol_point(1, 4, kSobolDimensions + 3).back());
}

}  // namespace
}  // namespace emax
