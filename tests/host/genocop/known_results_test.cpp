#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "run_search.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using benchmark::BenchmarkProblem;
using testing_help::run_search;

// Results of an earlier run enter for nothing: they are best from the first moment, never asked for
// again, and the search goes on from them.
TEST(KnownResults, AreAWarmStart) {
  BenchmarkProblem bench = benchmark::g04();
  Settings settings;
  settings.budget = 150;
  std::set<Genes> seen;
  const auto first =
      run_search(bench, settings, 69, [&](auto&&, const Candidate& c, const Evaluation& e) {
        bench.problem.known.emplace_back(c.genes, e);
        seen.insert(c.genes);
      });
  const Genocop warm(bench.problem, settings, 70);
  EXPECT_EQ(warm.best()->index, kKnownBefore);
  EXPECT_EQ(warm.best()->genes, first->genes);
  EXPECT_EQ(warm.asked(), 0u);
  settings.budget = 60;
  const auto best = run_search(bench, settings, 70, [&](auto&&, const Candidate& c, auto&&) {
    EXPECT_FALSE(seen.contains(c.genes)) << "candidate " << c.index;
  });
  EXPECT_LE(best->evaluation.objective, first->evaluation.objective);

  bench.problem.known = {{{0, 0, 0, 0, 0}, bench.evaluate({0, 0, 0, 0, 0})}};
  EXPECT_THROW(Genocop(bench.problem, settings, 1), Error);
}

TEST(KnownResults, AreCheckedLikeThoseThatAreTold) {
  BenchmarkProblem bench = benchmark::g04();
  const Genes genes = LinearDomain(bench.problem).inside();
  Evaluation evaluation = bench.evaluate(genes);
  evaluation.objective = -HUGE_VAL;
  bench.problem.known = {{genes, evaluation}};
  EXPECT_FALSE(Genocop(bench.problem, {}, 1).best());
  bench.problem.known = {{genes, {true, 1, -1}}};  // no value of a constraint
  EXPECT_THROW(Genocop(bench.problem, {}, 1), Error);
}

// All but one point of a small domain: no draw may hand out another.
TEST(KnownResults, AreNotAskedForWhenNothingNewIsFound) {
  BenchmarkProblem bench;
  bench.problem.genes.assign(3, {"n", Gene::Kind::kInteger, 0, 2});
  bench.evaluate = [](const Genes& g) { return Evaluation{true, g[0] - g[1] + g[2], -1.0}; };
  const Genes unknown = {1, 2, 0};
  for (int i = 0; i < 27; ++i) {
    const int second = i / 3 % 3, third = i / 9;
    const Genes genes = {double(i % 3), double(second), double(third)};
    if (genes != unknown) bench.problem.known.emplace_back(genes, bench.evaluate(genes));
  }
  Settings settings;
  settings.budget = 400;
  std::vector<Genes> asked;
  run_search(bench, settings, 76,
             [&](auto&&, const Candidate& c, auto&&) { asked.push_back(c.genes); });
  EXPECT_EQ(asked, std::vector<Genes>{unknown});
}

// A repair that ends in a point known before tells its search point what it is worth.
TEST(KnownResults, EndRepairsLikeNewOnes) {
  BenchmarkProblem bench;
  bench.problem.genes = {{"n", Gene::Kind::kInteger, 0, 20}};
  bench.evaluate = [](const Genes& g) { return Evaluation{true, -g[0], g[0] - 10}; };
  for (double n = 0; n < 20; ++n) bench.problem.known.emplace_back(Genes{n}, bench.evaluate({n}));
  bench.problem.starts = {{20}};
  Settings settings;
  settings.look_ahead = 1;
  settings.search_population = 30;
  settings.repair = RepairMethod::kDeterministic;
  settings.max_repair_tries = 10;
  settings.linear_model = false;
  Genocop search(bench.problem, settings, 77);
  ASSERT_EQ(search.ask().genes, Genes{20});
  search.tell(0, bench.evaluate({20}));
  for (std::uint64_t i = 1; i < 40; ++i) {  // the starts that are left come first
    const Candidate candidate = search.ask();
    EXPECT_TRUE(candidate.known || candidate.same_as);
    search.tell(i, bench.evaluate(candidate.genes));
  }
  const auto& population = search.search_population();
  const auto repaired = std::ranges::find(population, 0u, &Individual::id);
  ASSERT_NE(repaired, population.end());
  ASSERT_TRUE(repaired->repaired_objective);
  EXPECT_LE(*repaired->repaired_objective, 0);
  EXPECT_GE(*repaired->repaired_objective, -10);
}

}  // namespace
}  // namespace emax
