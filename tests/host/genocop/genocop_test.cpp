#include "host/genocop/genocop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "benchmark_problems.h"
#include "domain_check.h"
#include "run_search.h"
#include "staircase.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using benchmark::BenchmarkProblem;
using testing_help::run_search;

// A problem over the mixed domain: a feasible band that few points hit.
BenchmarkProblem mixed() {
  const auto evaluate = [](const Genes& g) {
    const double f = (g[0] - 4) * (g[0] - 4) + g[1] * g[2] + g[5] + 3 * g[3] - g[6];
    return Evaluation{true, f, std::abs(g[0] + g[1] - 3) - 0.5};
  };
  return {"mixed", testing_help::mixed_problem(), evaluate, 0};
}

TEST(Genocop, NoCandidateLeavesTheDomainInTenThousand) {
  Settings settings;
  settings.budget = 10000;
  const BenchmarkProblem bench = mixed();
  std::uint64_t checked = 0;
  run_search(bench, settings, 51, [&](const Genocop&, const Candidate& c, const Evaluation&) {
    ++checked;
    const std::string broken = testing_help::broken_rule(bench.problem, c.genes);
    if (!broken.empty())
      ADD_FAILURE() << "candidate " << c.index << ", " << c.origin << ": " << broken;
  });
  EXPECT_GT(checked, 9000u);  // the rest were repeats, answered without an evaluation
}

TEST(Genocop, ALargerBudgetKeepsTheCandidatesOfTheSmaller) {
  const auto candidates = [](std::size_t budget, const std::vector<std::size_t>& earlier) {
    Settings settings;
    settings.budget = budget;
    settings.earlier_budgets = earlier;
    std::vector<Genes> genes;
    run_search(mixed(), settings, 57, [&](const Genocop&, const Candidate& c, const Evaluation&) {
      genes.push_back(c.genes);
    });
    return genes;
  };
  const auto shorter = candidates(120, {}), longer = candidates(300, {120, 300});
  ASSERT_LT(shorter.size(), longer.size());
  EXPECT_TRUE(std::equal(shorter.begin(), shorter.end(), longer.begin()));
  EXPECT_NE(candidates(300, {}), longer);  // whose operators shrink later
  EXPECT_EQ(candidates(120, {120, 300}), shorter);
}

TEST(Genocop, NoPointIsHandedOutTwice) {
  Settings settings;
  settings.budget = 3000;
  std::set<Genes> seen;
  run_search(mixed(), settings, 52, [&](const Genocop&, const Candidate& c, const Evaluation&) {
    EXPECT_TRUE(seen.insert(c.genes).second) << "candidate " << c.index;
  });
}

TEST(Genocop, ASmallDomainIsExhaustedWithoutRepeats) {
  BenchmarkProblem bench;
  for (int i = 0; i < 3; ++i) {
    bench.problem.genes.push_back({"n", Gene::Kind::kInteger, 0, 2});
  }
  bench.evaluate = [](const Genes& g) { return Evaluation{true, g[0] - g[1] + g[2], -1.0}; };
  Settings settings;
  settings.budget = 400;
  int evaluations = 0;
  const auto best = run_search(bench, settings, 53, [&](auto&&...) { ++evaluations; });
  EXPECT_EQ(evaluations, 27);
  EXPECT_EQ(best->evaluation.objective, -2);
}

TEST(Genocop, EverythingFixedIsOneEvaluation) {
  BenchmarkProblem bench;
  bench.problem.genes = {{"x", Gene::Kind::kContinuous, 2, 2}};
  bench.evaluate = [](const Genes& g) { return Evaluation{true, g[0], -1.0}; };
  Settings settings;
  settings.budget = 40;
  int evaluations = 0;
  const auto best = run_search(bench, settings, 54, [&](auto&&...) { ++evaluations; });
  EXPECT_EQ(evaluations, 1);
  EXPECT_EQ(best->genes, Genes{2});
}

TEST(Genocop, EveryOriginAndOperatorOccurs) {
  std::map<std::string, int> origins;
  Settings settings;
  settings.budget = 600;
  const auto count = [&](const Genocop&, const Candidate& c, const Evaluation&) {
    ++origins[std::string(c.origin)];
  };
  run_search(benchmark::staircase(), settings, 55, count);
  settings.monotone_step = false;
  run_search(benchmark::staircase(), settings, 55, count);
  settings.finish = false;
  run_search(benchmark::staircase(), settings, 55, count);
  for (const OperatorEntry& entry : kOperators) EXPECT_GT(origins[std::string(entry.name)], 5);
  for (const char* origin : {"start", "repair", "climb", "linear_model", "finish"})
    EXPECT_GT(origins[origin], 0) << origin;
}

TEST(Genocop, AnOperatorOfFrequencyZeroIsNotUsed) {
  Settings settings;
  settings.budget = 500;
  settings.operator_frequencies.fill(0);
  settings.operator_frequencies[2] = 1;
  run_search(benchmark::g06(), settings, 56,
             [](const Genocop&, const Candidate& c, const Evaluation&) {
               for (std::size_t i = 0; i < kOperators.size(); ++i) {
                 if (i != 2) {
                   EXPECT_NE(c.origin, kOperators[i].name);
                 }
               }
             });
}

TEST(Genocop, ReferencesAreFeasibleAndPopulationsBounded) {
  for (const BenchmarkProblem& bench : {benchmark::g06(), mixed(), benchmark::staircase()}) {
    Settings settings;
    settings.budget = 1500;
    settings.reference_population = 6;
    std::size_t most = 0;
    run_search(bench, settings, 57,
               [&](const Genocop& search, const Candidate&, const Evaluation&) {
                 for (const Individual& reference : search.reference_population()) {
                   ASSERT_TRUE(reference.evaluation.feasible());
                 }
                 most = std::max(most, search.reference_population().size());
                 ASSERT_LE(search.search_population().size(), settings.search_population);
               });
    EXPECT_EQ(most, 6u) << bench.name;
  }
}

// A small feasible ball around the start and an objective that pulls away from it, so that most
// points need repair and most trials fail: each is a candidate of its own, none beyond the limit.
TEST(Genocop, RepairsAreChargedAndBounded) {
  BenchmarkProblem bench;
  bench.problem.genes = benchmark::continuous_genes(2, 0, 1);
  bench.problem.starts = {{0.5, 0.5}};
  bench.evaluate = [](const Genes& g) {
    const double squared_distance = (g[0] - 0.5) * (g[0] - 0.5) + (g[1] - 0.5) * (g[1] - 0.5);
    return Evaluation{true, -squared_distance, squared_distance - 0.01};
  };
  for (std::size_t tries : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
    Settings settings;
    settings.budget = 1000;
    settings.look_ahead = 1;
    settings.repair = RepairMethod::kRandom;
    settings.max_repair_tries = tries;
    std::size_t in_a_row = 0, longest = 0, repairs = 0, charged = 0;
    run_search(bench, settings, 58,
               [&](const Genocop& search, const Candidate& c, const Evaluation& e) {
                 const bool repair = c.origin == "repair";
                 repairs += repair;
                 // The repairs of the starts queue up; afterwards one search point is repaired at a
                 // time.
                 constexpr std::uint64_t kQueueServed = 100;
                 in_a_row = repair && c.index > kQueueServed ? in_a_row + 1 : 0;
                 longest = std::max(longest, in_a_row);
                 if (e.feasible()) in_a_row = 0;
                 charged = search.asked();
               });
    EXPECT_EQ(longest, tries);
    EXPECT_EQ(charged, 1000u);
    if (tries > 0) {
      EXPECT_GT(repairs, 100u);
    }
  }
}

TEST(Genocop, EverySettingOfRepairFindsFeasiblePoints) {
  for (RepairMethod method :
       {RepairMethod::kRandom, RepairMethod::kDeterministic, RepairMethod::kValueAware}) {
    Settings settings;
    settings.budget = 2000;
    settings.repair = method;
    settings.repair_only_promising = false;
    int repaired = 0;
    const auto best = run_search(benchmark::g07(), settings, 59,
                                 [&](const Genocop&, const Candidate& c, const Evaluation& e) {
                                   repaired += c.origin == "repair" && e.feasible();
                                 });
    EXPECT_GT(repaired, 50);
    EXPECT_TRUE(best->evaluation.feasible());
  }
}

TEST(Genocop, BestIsTheBestFeasibleElseTheLeastViolating) {
  BenchmarkProblem bench = benchmark::g06();
  Settings settings;
  settings.budget = 800;
  double least = 1e300;
  const auto observe = [&](const Genocop&, const Candidate&, const Evaluation& e) {
    if (e.feasible()) least = std::min(least, e.objective);
  };
  EXPECT_EQ(run_search(bench, settings, 60, observe)->evaluation.objective, least);

  double violation = 1e300;
  bench.problem.nonlinear.clear();
  bench.evaluate = [](const Genes& g) { return Evaluation{true, -g[0], 1 + g[0] * g[1]}; };
  const auto best =
      run_search(bench, settings, 61, [&](const Genocop& search, const Candidate&, auto& e) {
        violation = std::min(violation, e.violation);
        EXPECT_TRUE(search.reference_population().empty());
      });
  EXPECT_FALSE(best->evaluation.feasible());
  EXPECT_EQ(best->evaluation.violation, violation);
  EXPECT_LT(violation, 1.05);  // the violation itself is minimised: its least value is 1
}

TEST(Genocop, FailedEvaluationsNeverEnter) {
  BenchmarkProblem bench = benchmark::g04();
  const auto inner = bench.evaluate;
  bench.evaluate = [inner](const Genes& g) {
    Evaluation e = inner(g);
    if (g[0] < 85) return Evaluation{false, -1e9, -1};  // tempting, but crashed
    if (g[0] < 86) e.objective = std::nan("");
    return e;
  };
  Settings settings;
  settings.budget = 1500;
  const auto best = run_search(bench, settings, 62, [](const Genocop& search, auto&&...) {
    for (const Individual& i : search.search_population()) ASSERT_GE(i.free[0], 86);
    for (const Individual& i : search.reference_population()) ASSERT_GE(i.free[0], 86);
  });
  EXPECT_GE(best->genes[0], 86);

  bench.evaluate = [](const Genes&) { return Evaluation{}; };
  EXPECT_EQ(run_search(bench, settings, 63), std::nullopt);
}

TEST(Genocop, StartsComeFirstInTheirOrder) {
  BenchmarkProblem bench = benchmark::g06();
  bench.problem.starts = {{20, 30}, {15, 1}};
  std::vector<Genes> first;
  Settings settings;
  settings.budget = 20;
  run_search(bench, settings, 64, [&](const Genocop&, const Candidate& c, const Evaluation&) {
    if (first.size() < 2) first.push_back(c.genes);
  });
  EXPECT_EQ(first, bench.problem.starts);
}

// Genes that are not starts fall into as many slices as there are points, one in each.
TEST(Genocop, FurtherStartsAreStratifiedInEveryGene) {
  for (const bool sobol : {true, false}) {
    Settings settings;
    settings.budget = settings.look_ahead = 16;
    settings.sobol_starts = sobol;
    std::vector<std::set<int>> slices(2);
    run_search(benchmark::g11(), settings, 65,
               [&](const Genocop&, const Candidate& c, const Evaluation&) {
                 for (std::size_t k = 0; k < 2; ++k) {
                   slices[k].insert(static_cast<int>((c.genes[k] + 1) / 2 * 16));
                 }
               });
    EXPECT_EQ(slices[0].size(), 16u) << sobol;
    EXPECT_EQ(slices[1].size(), 16u) << sobol;
  }
}

// Every point between an infeasible one and its reference is worse than the reference.
TEST(Genocop, ARepairedPointThatLosesIsSharedOnlyWhereFeasiblePointsAre) {
  BenchmarkProblem bench;
  bench.problem.genes = benchmark::continuous_genes(1, 0, 1);
  bench.evaluate = [](const Genes& g) {
    return Evaluation{true, g[0] > 0.5 ? -1 : g[0], g[0] - 0.5};
  };
  for (const bool share : {true, false}) {
    Settings settings = Settings::original();
    settings.budget = 400;
    settings.search_population = settings.reference_population = 6;
    settings.share_feasible = share;
    std::set<std::uint64_t> repaired, entered;
    run_search(bench, settings, 69,
               [&](const Genocop& search, const Candidate& c, const Evaluation& e) {
                 if (c.origin == "repair" && e.feasible()) repaired.insert(c.index);
                 for (const Individual& reference : search.reference_population()) {
                   if (repaired.contains(reference.id)) entered.insert(reference.id);
                 }
               });
    EXPECT_GT(repaired.size(), 20u);
    EXPECT_EQ(entered.empty(), !share) << entered.size();
  }
}

TEST(Genocop, TheCacheAnswersWhatWasEvaluated) {
  BenchmarkProblem bench;
  bench.problem.genes = {{"n", Gene::Kind::kInteger, 0, 3}};
  bench.evaluate = [](const Genes& g) { return Evaluation{true, g[0], -1}; };
  for (const bool cache : {true, false}) {
    Settings settings;
    settings.budget = 20;
    settings.cache = cache;
    std::size_t evaluated = 0;
    run_search(bench, settings, 70,
               [&](const Genocop&, const Candidate&, const Evaluation&) { ++evaluated; });
    EXPECT_EQ(evaluated, cache ? 4u : 20u);
  }
}

TEST(Genocop, AskAndTellInsistOnTheirOrder) {
  Settings settings;
  settings.look_ahead = 2;
  Genocop search(benchmark::g06().problem, settings, 66);
  search.ask();
  EXPECT_THROW(search.tell(1, {}), std::logic_error);  // not asked yet
  search.ask();
  EXPECT_THROW(search.ask(), std::logic_error);        // needs result 0
  EXPECT_THROW(search.tell(1, {}), std::logic_error);  // 0 is next
  search.tell(0, {});
  search.ask();
  search.tell(1, {});
  search.tell(2, {});
  EXPECT_THROW(search.ask(), std::logic_error);  // 2 was told too early for candidate 3
}

// Every strategy changes what is asked when it is switched, and each setting gives the same bytes
// twice.
TEST(Genocop, EveryStrategyIsASwitchAndRepeatable) {
  const auto trail = [](const BenchmarkProblem& bench, const Settings& settings) {
    std::vector<Genes> genes;
    run_search(bench, settings, 67, [&](const Genocop&, const Candidate& c, const Evaluation&) {
      genes.push_back(c.genes);
    });
    return genes;
  };
  BenchmarkProblem hard = benchmark::g10();  // nothing feasible among the starts
  Settings base;
  base.budget = 300;
  const auto all = trail(hard, base);
  EXPECT_EQ(all, trail(hard, base));
  for (bool Settings::*strategy :
       {&Settings::linear_model, &Settings::finish, &Settings::adaptive_frequencies,
        &Settings::sobol_starts, &Settings::first_phase, &Settings::replace_worse_only,
        &Settings::share_feasible, &Settings::repair_only_promising}) {
    Settings settings = base;
    settings.*strategy = false;
    EXPECT_NE(trail(hard, settings), all);
  }
  Settings ten = base;
  ten.frequency_of(uniform_mutation) = 0;
  EXPECT_NE(trail(hard, ten), all);
  base.budget = 1500;
  Settings alone = base;
  alone.differential = false;
  EXPECT_NE(trail(benchmark::g01(), alone), trail(benchmark::g01(), base));
  base.budget = 300;
  Settings without = base;
  without.monotone_step = false;
  EXPECT_NE(trail(benchmark::staircase(), without), trail(benchmark::staircase(), base));
}

// Without the first phase nothing is done about the violation: points are drawn until one is
// feasible.
TEST(Genocop, WithoutTheFirstPhasePointsAreDrawnAtRandom) {
  BenchmarkProblem bench;
  bench.problem.genes = benchmark::continuous_genes(3, 0, 1);
  bench.problem.monotone_gene = 0;
  bench.evaluate = [](const Genes& g) { return Evaluation{true, g[0], 1 + g[1] + g[2]}; };
  Settings settings;
  settings.budget = 200;
  settings.first_phase = false;
  for (const bool monotone : {true, false}) {
    settings.monotone_step = monotone;
    run_search(bench, settings, 75, [&](const Genocop&, const Candidate& c, auto&&) {
      const bool drawn = c.origin == "start" || c.origin == "sample";
      EXPECT_TRUE(drawn) << "candidate " << c.index << ", " << c.origin;
    });
  }
}

// Nothing can be modelled there, so no local search starts.
TEST(Genocop, ViolationsMayBeInfinite) {
  BenchmarkProblem bench;
  bench.problem.genes = benchmark::continuous_genes(2, 0, 1);
  bench.evaluate = [](const Genes& g) { return Evaluation{true, g[0], HUGE_VAL}; };
  Settings settings;
  settings.budget = 60;
  const auto best = run_search(bench, settings, 74);
  EXPECT_EQ(best->evaluation.violation, HUGE_VAL);
}

// Two methods with a parameter each: points that differ in the other method's parameter alone are
// one, and one evaluation serves them.
TEST(Genocop, ParametersOfAnotherMethodDoNotCount) {
  BenchmarkProblem bench;
  bench.problem.genes = {{"method", Gene::Kind::kCategorical, 0, 1},
                         {"a", Gene::Kind::kInteger, 0, 4, Gene::Condition{0, 0}},
                         {"b", Gene::Kind::kInteger, 0, 4, Gene::Condition{0, 1}}};
  bench.evaluate = [](const Genes& g) { return Evaluation{true, g[0] == 0 ? 3 + g[1] : g[2], -1}; };
  Settings settings;
  settings.budget = 300;
  std::set<std::pair<double, double>> effective;
  int evaluations = 0;
  const auto best =
      run_search(bench, settings, 71, [&](const Genocop&, const Candidate& c, auto&&) {
        ++evaluations;
        effective.emplace(c.genes[0], c.genes[0] == 0 ? c.genes[1] : c.genes[2]);
      });
  EXPECT_EQ(evaluations, 10);
  EXPECT_EQ(effective.size(), 10u);
  EXPECT_EQ(best->evaluation.objective, 0);
}

// The cache rounds: with a coarse resolution neighbours are one point.
TEST(Genocop, NoTwoEvaluationsFallIntoOneCellOfTheCache) {
  Settings settings;
  settings.budget = 500;
  settings.cache_resolution = 0.01;
  std::set<std::pair<long, long>> cells;
  int evaluations = 0;
  const BenchmarkProblem bench = benchmark::g11();
  run_search(bench, settings, 72, [&](const Genocop&, const Candidate& c, auto&&) {
    ++evaluations;
    const auto cell = [](double x) { return std::lround(std::floor((x + 1) / 0.02 + 0.5)); };
    EXPECT_TRUE(cells.emplace(cell(c.genes[0]), cell(c.genes[1])).second);
  });
  EXPECT_GT(evaluations, 100);
}

TEST(Genocop, ConstraintValuesAreAskedForWhereTheProblemNamesThem) {
  Genocop search(benchmark::g06().problem, {}, 73);
  search.ask();
  EXPECT_THROW(search.tell(0, {true, 1, -1}), std::logic_error);
}

TEST(Genocop, RefusesAProblemWithoutGenes) {
  try {
    Genocop({}, {}, 1);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the problem has no genes; give it at least one");
  }
}

TEST(Genocop, RefusesSettingsOutOfRange) {
  const auto refused = [](auto change) {
    Settings settings;
    change(settings);
    EXPECT_THROW(Genocop(benchmark::g06().problem, settings, 1), Error);
  };
  refused([](Settings& s) { s.look_ahead = 0; });
  refused([](Settings& s) { s.search_population = 0; });
  refused([](Settings& s) { s.selection_pressure = 1; });
  refused([](Settings& s) { s.operator_frequencies.fill(0); });
  refused([](Settings& s) { s.operator_frequencies[0] = -1; });
}

}  // namespace
}  // namespace emax
