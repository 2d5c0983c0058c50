#include "host/mpi/rank_dispatch.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>

#include "host/parameters/registry.h"

namespace emax::test {
namespace {

RunMessage run(std::uint64_t ticket, int neighbours) {
  ChainSettings settings{"gp3", "bounded", ParameterValues(chain_parameters("gp3", "bounded"))};
  settings.parameters.set(Normals::kNeighbours, neighbours);
  return {ticket, settings};
}

TEST(RankDispatch, GivesARankNoMoreThanItHasWorkers) {
  std::mt19937_64 generator(7);
  const std::vector<unsigned> workers = {2, 0, 3, 1};
  RankDispatch dispatch(workers);
  std::vector<std::map<std::uint64_t, int>> running(workers.size());
  std::uint64_t submitted = 0, completed = 0;
  while (completed < 300) {
    const bool submits = submitted < 300 && generator() % 2 == 0;
    if (submits) dispatch.submit(run(submitted++, 10 + static_cast<int>(generator() % 4)));
    while (const auto assignment = dispatch.next()) {
      running[assignment->rank][assignment->run.ticket] = 0;
      EXPECT_LE(running[assignment->rank].size(), workers[assignment->rank]);
    }
    const std::size_t busy = running[0].size() + running[2].size() + running[3].size();
    // Nothing waits while a worker is free.
    if (dispatch.outstanding() > busy) {
      EXPECT_EQ(busy, 6u);
    }
    const std::size_t rank = generator() % workers.size();
    EXPECT_EQ(dispatch.is_busy(rank), !running[rank].empty());
    if (running[rank].empty()) continue;
    const std::uint64_t ticket = running[rank].begin()->first;
    EXPECT_TRUE(dispatch.complete(rank, ticket));
    EXPECT_FALSE(dispatch.complete(rank, ticket));
    running[rank].erase(ticket);
    ++completed;
  }
  EXPECT_EQ(dispatch.outstanding(), 0u);
}

TEST(RankDispatch, PrefersTheRankThatHasTheReconstruction) {
  RankDispatch dispatch(std::vector<unsigned>{1, 1});
  dispatch.submit(run(0, 10));
  dispatch.submit(run(1, 20));
  ASSERT_EQ(dispatch.next()->rank, 0u);
  ASSERT_EQ(dispatch.next()->rank, 1u);
  dispatch.submit(run(2, 20));  // first in the queue, and rank 1 made it
  dispatch.submit(run(3, 10));
  dispatch.complete(0, 0);
  auto next = dispatch.next();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->rank, 0u);
  EXPECT_EQ(next->run.ticket, 3u);
  dispatch.complete(1, 1);
  next = dispatch.next();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->rank, 1u);
  EXPECT_EQ(next->run.ticket, 2u);
}

TEST(RankDispatch, DropsWhatIsQueuedAlone) {
  RankDispatch dispatch(std::vector<unsigned>{1});
  dispatch.submit(run(0, 10));
  dispatch.submit(run(1, 10));
  ASSERT_TRUE(dispatch.next());
  dispatch.drop_queued();
  EXPECT_EQ(dispatch.outstanding(), 1u);
  EXPECT_TRUE(dispatch.complete(0, 0));
  EXPECT_FALSE(dispatch.next());
}

TEST(SpreadWorkers, FollowsTheProcessors) {
  using Counts = std::vector<unsigned>;
  EXPECT_EQ(spread_workers(4, Counts{1, 1, 1, 1}), (Counts{1, 1, 1, 1}));
  EXPECT_EQ(spread_workers(2, Counts{1, 1, 1, 1}), (Counts{1, 1, 0, 0}));
  EXPECT_EQ(spread_workers(10, Counts{8, 2}), (Counts{8, 2}));
  EXPECT_EQ(spread_workers(5, Counts{8, 2}), (Counts{4, 1}));
  EXPECT_EQ(spread_workers(12, Counts{2, 2, 2}), (Counts{4, 4, 4}));
}

}  // namespace
}  // namespace emax::test
