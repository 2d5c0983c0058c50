#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "benchmark_problems.h"
#include "cec2006_problems.h"
#include "host/genocop/genocop.h"
#include "run_search.h"
#include "staircase.h"

namespace emax {
namespace {

using benchmark::BenchmarkProblem;
using testing_help::run_search;

struct Told {
  Genes genes;
  std::string_view origin;
  Evaluation evaluation;
};

std::vector<Told> trail(const BenchmarkProblem& bench, const Settings& settings) {
  std::vector<Told> results;
  run_search(bench, settings, 29, [&](const Genocop&, const Candidate& c, const Evaluation& e) {
    results.push_back({c.genes, c.origin, e});
  });
  return results;
}

std::vector<Genes> genes(const std::vector<Told>& results) {
  std::vector<Genes> all;
  for (const Told& told : results) all.push_back(told.genes);
  return all;
}

bool gains(const Evaluation& evaluation, const std::optional<Evaluation>& best) {
  if (!best || evaluation.feasible() != best->feasible()) {
    return !best || evaluation.feasible();
  }
  const double now = evaluation.feasible() ? evaluation.objective : evaluation.violation;
  const double before = best->feasible() ? best->objective : best->violation;
  return now < before - 1e-6 * std::abs(before);
}

// The rule told again from the results alone, one result after the other.
std::vector<std::size_t> beginnings(const std::vector<Told>& results, const Settings& settings) {
  std::vector<std::size_t> found = {0};
  std::optional<Evaluation> best;
  std::size_t gained = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::size_t after_starts = found.back() + settings.search_population;
    if (i >= std::max(gained, after_starts) + settings.restart_after) {
      found.push_back(i);
      best.reset();
      gained = 0;
    }
    if (gains(results[i].evaluation, best)) {
      best = results[i].evaluation;
      gained = i + 1;
    }
  }
  return found;
}

TEST(Restart, StartsAreAskedForAfterAsManyResultsWithoutGain) {
  Settings settings;
  settings.budget = 1500;
  settings.look_ahead = 1;
  settings.restart_after = 100;
  const std::vector<Told> results = trail(benchmark::g08(), settings);
  std::vector<std::size_t> starts, expected;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].origin == "start") starts.push_back(i);
  }
  for (std::size_t first : beginnings(results, settings)) {
    const std::size_t end = std::min(first + settings.search_population, results.size());
    for (std::size_t i = first; i < end; ++i) expected.push_back(i);
  }
  EXPECT_GT(expected.size(), 3 * settings.search_population);
  EXPECT_EQ(starts, expected);
}

TEST(Restart, KeepsTheBestPointAndNoIndividual) {
  Settings settings;
  settings.budget = 1500;
  settings.look_ahead = 1;
  settings.restart_after = 100;
  std::optional<Evaluation> best;
  std::uint64_t first = 0, begun = 0;  // of the last starts in a row
  std::string_view last;
  run_search(benchmark::g08(), settings, 29,
             [&](const Genocop& search, const Candidate& c, const Evaluation& e) {
               if (c.origin == "start" && last != "start") {
                 first = c.index;
                 ++begun;
               }
               last = c.origin;
               if (best) {  // `search` has not been told `e` yet
                 EXPECT_EQ(search.best()->evaluation.objective, best->objective);
               }
               if (e.feasible() && (!best || e.objective < best->objective)) best = e;
               for (const auto* population :
                    {&search.search_population(), &search.reference_population()}) {
                 for (const Individual& individual : *population) EXPECT_GE(individual.id, first);
               }
             });
  EXPECT_GT(begun, 3U);
}

TEST(Restart, SolvesWhatOneDescentMisses) {
  Settings settings;
  settings.budget = 5000;
  settings.look_ahead = 1;
  const BenchmarkProblem bench = benchmark::g13();
  const auto solved = [&](std::size_t restart_after) {
    settings.restart_after = restart_after;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const std::optional<Best> best = run_search(bench, settings, seed);
      if (best && best->evaluation.feasible() &&
          best->evaluation.objective - bench.optimum < 1e-4) {
        ++count;
      }
    }
    return count;
  };
  EXPECT_EQ(solved(300), 5);
  EXPECT_LT(solved(0), 5);
}

TEST(Restart, ALargerBudgetKeepsTheCandidatesOfTheSmaller) {
  Settings smaller;
  smaller.budget = 400;
  smaller.restart_after = 60;
  Settings larger = smaller;
  larger.budget = 900;
  larger.earlier_budgets = {400, 900};
  const std::vector<Genes> first = genes(trail(benchmark::g08(), smaller));
  const std::vector<Genes> all = genes(trail(benchmark::g08(), larger));
  ASSERT_LT(first.size(), all.size());
  EXPECT_TRUE(std::equal(first.begin(), first.end(), all.begin()));
}

// The walk and the climb along a monotone gene have no end of their own to wait for.
TEST(Restart, HappensOnlyWhereLocalSearchesRun) {
  Settings with;
  with.budget = 600;
  with.restart_after = 20;
  Settings without = with;
  without.restart_after = 0;
  EXPECT_EQ(genes(trail(benchmark::staircase(), with)),
            genes(trail(benchmark::staircase(), without)));
  EXPECT_NE(genes(trail(benchmark::g08(), with)), genes(trail(benchmark::g08(), without)));
}

}  // namespace
}  // namespace emax
