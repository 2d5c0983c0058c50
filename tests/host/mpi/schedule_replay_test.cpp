#include "tests/host/mpi/schedule_replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace emax::test {
namespace {

TEST(ScheduleReplay, OneWorkerTakesTheSum) {
  const std::vector<double> costs = {3, 1, 2};
  const Replay replay = replay_schedule(costs, {1}, 16, 0.5);
  EXPECT_DOUBLE_EQ(replay.seconds, 6 + 3 * 0.5);
  EXPECT_DOUBLE_EQ(replay.efficiency, 6 / 7.5);
}

TEST(ScheduleReplay, WaitsForWhatACandidateDependsOn) {
  // Candidate 2 needs result 0, candidate 3 result 1.
  const std::vector<double> costs = {4, 1, 1, 1};
  EXPECT_DOUBLE_EQ(replay_schedule(costs, {1, 1}, 2, 0).seconds, 5);
  EXPECT_DOUBLE_EQ(replay_schedule(costs, {1, 1}, 4, 0).seconds, 4);
  EXPECT_DOUBLE_EQ(replay_schedule(costs, {1, 1}, 1, 0).seconds, 7);
}

// No schedule is shorter than the longest evaluation or an equal share of all; list scheduling is
// at most twice as long (Graham 1966) where nothing waits for a result.
TEST(ScheduleReplay, StaysWithinTheBoundsOfListScheduling) {
  std::mt19937_64 generator(1);
  for (int repeat = 0; repeat < 50; ++repeat) {
    std::vector<double> costs(60);
    for (double& cost : costs) cost = std::exponential_distribution(1.0)(generator);
    const std::vector<unsigned> workers = {2, 1, 3};
    const double share = std::accumulate(costs.begin(), costs.end(), 0.0) / 6;
    const double least = std::max(share, *std::ranges::max_element(costs));
    const double took = replay_schedule(costs, workers, costs.size(), 0).seconds;
    EXPECT_GE(took, least * (1 - 1e-12));
    EXPECT_LE(took, 2 * least);
  }
}

}  // namespace
}  // namespace emax::test
