#include "host/measure/farthest_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/support/stimuli.h"

namespace emax {
namespace {

// All points sorted.
FarthestPoints::Excluded brute_force(const std::vector<std::uint32_t>& bits, std::size_t excludable,
                                     std::uint32_t allowed) {
  std::vector<std::uint32_t> order(bits.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return bits[a] != bits[b] ? bits[a] > bits[b] : a > b;
  });
  FarthestPoints::Excluded result;
  std::size_t kept = 0;
  while (kept < excludable && bits[order[kept]] > allowed) result.excluded.push_back(order[kept++]);
  const auto lowest = [&](std::uint32_t value) {
    return static_cast<std::uint32_t>(std::ranges::find(bits, value) - bits.begin());
  };
  result.all = {bits[order[0]], lowest(bits[order[0]])};
  result.kept = {bits[order[kept]], lowest(bits[order[kept]])};
  std::ranges::sort(result.excluded);
  return result;
}

TEST(FarthestPoints, AreThoseOfSortingAllInPiecesOfAnyOrder) {
  test::Random random(71);
  for (int round = 0; round < 300; ++round) {
    // Few values, so that many points are equally far.
    const auto values = static_cast<std::uint32_t>(random.uniform(1, round % 3 == 0 ? 3 : 50));
    std::vector<std::uint32_t> bits(static_cast<std::size_t>(random.uniform(1, 80)));
    for (std::uint32_t& b : bits) b = static_cast<std::uint32_t>(random.uniform(0, values));
    for (const std::size_t excludable : {std::size_t{0}, std::size_t{1}, bits.size() / 3}) {
      if (excludable >= bits.size()) continue;
      FarthestPoints points(excludable);
      const auto half = static_cast<std::uint32_t>(random.uniform(0, double(bits.size())));
      points.add(std::span(bits).subspan(half), {half});
      points.add(std::span(bits).first(half), {});
      for (const std::uint32_t allowed : {0u, values / 2, values}) {
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << bits.size() << " points, "
                                        << excludable << " may go beyond " << allowed);
        const auto found = points.exclude(allowed);
        const auto expected = brute_force(bits, excludable, allowed);
        EXPECT_EQ(found.kept, expected.kept);
        EXPECT_EQ(found.all, expected.all);
        EXPECT_EQ(found.excluded, expected.excluded);
      }
    }
  }
}

TEST(FarthestPoints, HaveTheNumbersThatAreListed) {
  const std::vector<std::uint32_t> bits = {3, 9, 9, 1}, numbers = {2, 5, 70, 71};
  FarthestPoints points(1);
  points.add(bits, {0, numbers});
  EXPECT_EQ(points.exclude(4).excluded, std::vector<std::uint32_t>{70});
  EXPECT_EQ(points.exclude(4).kept, (EmaxResult{9, 5}));
  EXPECT_EQ(points.exclude(9).kept, (EmaxResult{9, 5}));
}

}  // namespace
}  // namespace emax
