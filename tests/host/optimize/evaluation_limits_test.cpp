#include "host/optimize/evaluation_limits.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

using namespace std::chrono_literals;

TEST(SearchBudget, FollowsEffortAndPoints) {
  using enum SearchEffort;
  using enum SearchSpace;
  EXPECT_EQ(search_budget(kQuick, 1'000'000, kOneReference, {}), 1u);
  EXPECT_EQ(search_budget(kQuick, 1'000, kOneReference, 77), 1u);
  EXPECT_GT(search_budget(kQuick, 1'000, kDecimations, {}), 1u);
  EXPECT_EQ(search_budget(kNormal, 1'000, kOneReference, 77), 77u);
  EXPECT_EQ(search_budget(kDeep, 1'000'000, kOneReference, 77), 308u);
  // From one reference: ten minutes on two cores.
  EXPECT_EQ(search_budget(kNormal, 3, kOneReference, {}), 16u);
  EXPECT_EQ(search_budget(kNormal, 40'000, kOneReference, {}), 16u);
  EXPECT_EQ(search_budget(kDeep, 40'000, kOneReference, {}), 64u);
  const std::uint64_t large = search_budget(kNormal, 240'000, kOneReference, {});
  EXPECT_GE(large, 2u);
  EXPECT_LT(large, search_budget(kNormal, 120'000, kOneReference, {}));
  EXPECT_LE(search_budget(kNormal, 10'000'000, kOneReference, {}), large);
  EXPECT_EQ(search_budget(kNormal, 10'000'000, kOneReference, {}), 2u);
  // Or one that is deep.
  EXPECT_FALSE(decimates_deep_at_once(240'000));
  EXPECT_TRUE(decimates_deep_at_once(250'000));
  EXPECT_FALSE(decimates_deep_at_once(10'000'000));
  EXPECT_EQ(search_budget(kNormal, 400'000, kOneReference, {}), 1u);
  EXPECT_EQ(search_budget(kNormal, 400'000, kOneReference, 5), 5u);
  EXPECT_GT(search_budget(kDeep, 400'000, kOneReference, {}), 4u);
  EXPECT_LT(polished_candidates(10'000'000), polished_candidates(40'000));
  for (const SearchSpace space : {kSurfaces, kDecimations}) {
    const std::uint64_t normal = search_budget(kNormal, 100'000, space, {});
    EXPECT_EQ(search_budget(kNormal, 3, space, {}), normal);
    EXPECT_EQ(search_budget(kDeep, 3, space, {}), 4 * normal);
    EXPECT_EQ(search_budget(kNormal, 200'000, space, {}), normal / 2);
    EXPECT_EQ(search_budget(kNormal, 100'000'000, space, {}), normal / 5);
  }
}

TEST(ExpectedSeconds, FollowRoundsAndPoints) {
  using enum SearchSpace;
  EXPECT_EQ(expected_seconds(kOneReference, 40'000, 0, 0, 2), 0);
  for (const SearchSpace space : {kOneReference, kSurfaces, kDecimations}) {
    const double one = expected_seconds(space, 40'000, 1, 0, 4);
    EXPECT_GT(one, 1);
    EXPECT_EQ(expected_seconds(space, 40'000, 4, 0, 4), one);
    EXPECT_EQ(expected_seconds(space, 40'000, 5, 0, 4), 2 * one);
    EXPECT_GT(expected_seconds(space, 80'000, 1, 0, 4), one);
    EXPECT_GT(expected_seconds(space, 40'000, 1, 1, 4), 2 * one);
  }
  // What a person waits for by default.
  for (const std::size_t points : {1'000u, 100'000u, 10'000'000u}) {
    const std::uint64_t budget = search_budget(SearchEffort::kNormal, points, kOneReference, {});
    EXPECT_LT(expected_seconds(kOneReference, points, budget, polished_candidates(points), 2), 900)
        << points;
  }
}

TEST(EvaluationLimits, GrowWithTheCloud) {
  EXPECT_EQ(standard_limits(1000).time, 10min);
  EXPECT_EQ(standard_limits(1'000'000).time, 2000s);
  TemporaryFolder folder;
  const std::uint64_t machine = usable_memory("no such file");
  EXPECT_EQ(usable_memory(folder.write("limit", "max\n")), machine);
  EXPECT_EQ(usable_memory(folder.write("limit", "123456789\n")), 123456789u);
  EXPECT_EQ(usable_memory(folder.write("limit", "18446744073709551615\n")), machine);
#ifndef EMAX_UNLIMITED_ADDRESS_SPACE
  const std::uint64_t usable = usable_memory(), most = usable - usable / 8;
  EXPECT_EQ(standard_limits(0).memory, std::min(most, std::uint64_t{2} << 30));
  EXPECT_EQ(standard_limits(1'000'000'000).memory,
            std::min(most, std::uint64_t{8'194'147'483'648}));
  EXPECT_EQ(jobs_in_memory({10min, most}), 4u);
  EXPECT_EQ(jobs_in_memory({10min, 100 * most}), 1u);
  EXPECT_GT(jobs_in_memory({10min, 0}), 1000u);
#endif
}

}  // namespace
}  // namespace emax::test
