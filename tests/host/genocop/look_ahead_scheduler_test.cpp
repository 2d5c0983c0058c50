#include "host/genocop/look_ahead_scheduler.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "staircase.h"

namespace emax {
namespace {

struct Trace {
  std::string bytes;  // of all candidates, in the order of their index
  std::vector<Genes> candidates;
  bool finished = false;
  std::size_t most_out = 0;
};

void append(std::string& bytes, const Candidate& candidate) {
  bytes += std::to_string(candidate.index) + ' ' + std::string(candidate.origin) + ' ';
  for (double gene : candidate.genes) {
    char raw[sizeof gene];
    std::memcpy(raw, &gene, sizeof gene);
    bytes.append(raw, sizeof raw);
  }
}

// Workers that finish in an order drawn at random.
Trace simulate(const benchmark::BenchmarkProblem& bench, const Settings& settings,
               std::uint64_t seed, std::size_t workers, std::uint64_t order_seed) {
  Genocop search(bench.problem, settings, seed);
  LookAheadScheduler scheduler(search, settings.budget);
  RandomStream order(order_seed, 0, RandomStream::Purpose::kTest);
  std::vector<Candidate> busy;
  Trace run;
  for (;;) {
    while (busy.size() < workers) {
      const auto candidate = scheduler.next();
      if (!candidate) break;
      append(run.bytes, *candidate);
      run.candidates.push_back(candidate->genes);
      busy.push_back(*candidate);
    }
    run.most_out = std::max(run.most_out, busy.size());
    if (busy.empty()) break;
    std::swap(busy[order.below(busy.size())], busy.back());
    scheduler.complete(busy.back().index, bench.evaluate(busy.back().genes));
    busy.pop_back();
  }
  run.finished = scheduler.finished();
  return run;
}

TEST(LookAheadScheduler, CandidatesDoNotDependOnTheWorkers) {
  for (const auto& bench : {benchmark::staircase(), benchmark::g07(), benchmark::g01()}) {
    for (std::uint64_t look_ahead : {std::uint64_t{1}, std::uint64_t{4}, std::uint64_t{16}}) {
      Settings settings;
      settings.budget = 400;
      settings.look_ahead = look_ahead;
      const Trace alone = simulate(bench, settings, 71, 1, 0);
      EXPECT_TRUE(alone.finished);
      for (std::size_t workers : {2u, 5u, 40u}) {
        for (std::uint64_t order = 1; order <= 4; ++order) {
          const Trace run = simulate(bench, settings, 71, workers, order);
          SCOPED_TRACE(testing::Message() << bench.name << ", look-ahead " << look_ahead << ", "
                                          << workers << " workers, order seed " << order);
          EXPECT_TRUE(run.finished);
          EXPECT_TRUE(run.bytes == alone.bytes);
          EXPECT_LE(run.most_out, look_ahead);
        }
      }
    }
  }
}

TEST(LookAheadScheduler, SeedAndLookAheadAreWhatTheCandidatesDependOn) {
  Settings settings;
  settings.budget = 200;
  const auto bench = benchmark::staircase();
  const Trace first = simulate(bench, settings, 72, 1, 0);
  EXPECT_TRUE(simulate(bench, settings, 72, 1, 0).bytes == first.bytes);
  EXPECT_FALSE(simulate(bench, settings, 73, 1, 0).bytes == first.bytes);
  settings.look_ahead = 8;
  EXPECT_FALSE(simulate(bench, settings, 72, 1, 0).bytes == first.bytes);
}

// The claim itself: with another result r, candidates up to r + K - 1 stay and later ones change.
TEST(LookAheadScheduler, ACandidateKnowsExactlyTheResultsUpToItsIndexMinusK) {
  Settings settings;
  settings.budget = 120;
  settings.look_ahead = 8;
  auto bench = benchmark::g07();
  bench.problem.nonlinear
      .clear();  // the greatest violation alone, so that a result is three numbers
  bench.evaluate = [all = bench.evaluate](const Genes& genes) {
    const Evaluation e = all(genes);
    return Evaluation{e.evaluated_ok, e.objective, e.violation};
  };
  const Trace before = simulate(bench, settings, 74, 3, 1);
  constexpr std::size_t kChanged = 40;
  const auto inner = bench.evaluate;
  const Genes changed = before.candidates[kChanged];
  bench.evaluate = [&](const Genes& genes) {
    return genes == changed ? Evaluation{true, -1000, -1} : inner(genes);
  };
  const Trace after = simulate(bench, settings, 74, 3, 1);
  for (std::size_t i = 0; i < kChanged + 8; ++i) {
    EXPECT_EQ(after.candidates[i], before.candidates[i]) << "candidate " << i;
  }
  EXPECT_NE(std::vector<Genes>(after.candidates.begin() + kChanged + 8, after.candidates.end()),
            std::vector<Genes>(before.candidates.begin() + kChanged + 8, before.candidates.end()));
}

TEST(LookAheadScheduler, TellsResultsInOrderAndEndsWithTheLast) {
  Settings settings;
  settings.budget = 3;
  const auto bench = benchmark::g06();
  Genocop search(bench.problem, settings, 75);
  LookAheadScheduler scheduler(search, settings.budget);
  std::vector<Candidate> out;
  for (int i = 0; i < 3; ++i) out.push_back(*scheduler.next());
  EXPECT_EQ(scheduler.next(), std::nullopt);
  scheduler.complete(out[2].index, bench.evaluate(out[2].genes));
  scheduler.complete(out[0].index, bench.evaluate(out[0].genes));
  EXPECT_FALSE(scheduler.finished());
  EXPECT_EQ(search.told(), 1u);
  scheduler.complete(out[1].index, {});  // was killed
  EXPECT_TRUE(scheduler.finished());
}

TEST(LookAheadScheduler, RefusesResultsThatAreNotAwaited) {
  Settings settings;
  const auto bench = benchmark::g06();
  Genocop search(bench.problem, settings, 76);
  LookAheadScheduler scheduler(search, 10);
  scheduler.next();
  EXPECT_THROW(scheduler.complete(1, {}), std::logic_error);
  scheduler.complete(0, {});
  EXPECT_THROW(scheduler.complete(0, {}), std::logic_error);
}

}  // namespace
}  // namespace emax
