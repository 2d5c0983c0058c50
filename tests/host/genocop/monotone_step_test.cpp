#include "host/genocop/monotone_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "run_search.h"
#include "staircase.h"

namespace emax {
namespace {

Problem two_genes(Gene::Kind kind = Gene::Kind::kContinuous, double upper = 1) {
  Problem p;
  p.genes = {{"other", Gene::Kind::kContinuous, 0, 1}, {"step", kind, 0, upper}};
  return p;
}

// Objective 100 (1 - x); violation passes zero at 0.7 - 0.1 other.
Evaluation smooth(const Genes& g) { return {true, 100 * (1 - g[1]), g[1] - 0.7 + 0.1 * g[0]}; }

Genes climb_until_done(MonotoneStep& step, Evaluation (*evaluate)(const Genes&), int& trials) {
  Genes best;
  double least = 1e300;
  for (trials = 0; trials < 60; ++trials) {
    const std::optional<Genes> trial = step.climb();
    if (!trial) break;
    step.asked(*trial);
    const Evaluation e = evaluate(*trial);
    if (e.feasible() && e.objective < least) {
      least = e.objective;
      best = *trial;
    }
    step.told(*trial, e);
  }
  return best;
}

TEST(MonotoneStep, GenesWithoutAMeaningTellNoLinesApart) {
  Problem p = two_genes();
  p.genes.push_back({"method", Gene::Kind::kCategorical, 0, 1});
  p.genes.push_back({"own", Gene::Kind::kContinuous, 2, 3, Gene::Condition{2, 1}});
  p.genes.push_back({"held", Gene::Kind::kContinuous, 2, 3, Gene::Condition{2, 1}});
  p.linear = {{{{0, 1}, {4, 1}}, LinearConstraint::Relation::kAtMost, 3.5}};
  const LinearDomain domain(p);
  const MonotoneStep step(domain, 1, {});
  EXPECT_TRUE(step.same_line({0.1, 0.2, 0, 2, 2}, {0.1, 0.7, 0, 3, 2}));
  EXPECT_FALSE(step.same_line({0.1, 0.2, 1, 2, 2}, {0.1, 0.7, 1, 3, 2}));
  EXPECT_FALSE(step.same_line({0.1, 0.2, 0, 2, 2}, {0.1, 0.7, 0, 2, 3}));
}

TEST(MonotoneStep, ClimbsToTheConstraintInFewTrials) {
  const LinearDomain domain(two_genes());
  Settings settings;
  settings.monotone_gain = 1e-3;
  MonotoneStep step(domain, 1, settings);
  EXPECT_EQ(step.climb(), std::nullopt);
  for (double x : {0.1, 0.3}) {
    step.asked({0.5, x});
    step.told({0.5, x}, smooth({0.5, x}));
  }
  EXPECT_NEAR(step.price(), 100, 1e-9);
  int trials = 0;
  const Genes best = climb_until_done(step, smooth, trials);
  ASSERT_EQ(best.size(), 2u);
  EXPECT_EQ(best[0], 0.5);
  EXPECT_NEAR(best[1], 0.65, 1e-3);
  EXPECT_LE(trials, 8);
}

TEST(MonotoneStep, GoesDownFromAnInfeasibleStart) {
  const LinearDomain domain(two_genes());
  Settings settings;
  settings.monotone_gain = 1e-3;
  MonotoneStep step(domain, 1, settings);
  step.asked({0, 0.9});
  step.told({0, 0.9}, smooth({0, 0.9}));
  int trials = 0;
  const Genes best = climb_until_done(step, smooth, trials);
  ASSERT_EQ(best.size(), 2u);
  EXPECT_NEAR(best[1], 0.7, 1e-2);

  MonotoneStep dead(domain, 1, settings);
  const auto never = [](const Genes& g) { return Evaluation{true, 1, 1 + g[1]}; };
  dead.asked({0, 0.9});
  dead.told({0, 0.9}, never({0, 0.9}));
  EXPECT_EQ(climb_until_done(dead, never, trials), Genes{});
  EXPECT_LE(trials, 20);
}

TEST(MonotoneStep, IntegerGeneEndsAtTheLastFeasibleStep) {
  const LinearDomain domain(two_genes(Gene::Kind::kInteger, 100));
  Settings settings;
  settings.monotone_gain = 1e-6;
  MonotoneStep step(domain, 1, settings);
  const auto stairs = [](const Genes& g) { return Evaluation{true, 200 - g[1], g[1] - 61.5}; };
  for (double x : {10.0, 90.0}) {
    step.asked({0, x});
    step.told({0, x}, stairs({0, x}));
  }
  int trials = 0;
  const Genes best = climb_until_done(step, stairs, trials);
  EXPECT_EQ(best, (Genes{0, 61}));
  EXPECT_LE(trials, 12);
}

TEST(MonotoneStep, HoldsAtMostItsTrialsInFlight) {
  const LinearDomain domain(two_genes());
  Settings settings;
  settings.monotone_in_flight = 3;
  MonotoneStep step(domain, 1, settings);
  for (double x : {0.1, 0.3}) {
    step.asked({0.5, x});
    step.told({0.5, x}, smooth({0.5, x}));
  }
  std::vector<double> out;
  while (const std::optional<Genes> trial = step.climb()) {
    step.asked(*trial);
    out.push_back((*trial)[1]);
    ASSERT_LE(out.size(), 3u);
  }
  EXPECT_EQ(out.size(), 3u);
  std::sort(out.begin(), out.end());
  EXPECT_EQ(std::unique(out.begin(), out.end()), out.end());
}

TEST(MonotoneStep, AimsAtWhatJustBeatsTheIncumbent) {
  const LinearDomain domain(two_genes());
  Settings settings;
  settings.monotone_gain = 0.02;
  MonotoneStep step(domain, 1, settings);
  const Genes parent = {0.5, 0.6};
  for (const Genes& g : {Genes{0.5, 0.3}, parent}) {
    step.asked(g);
    step.told(g, smooth(g));
  }
  const Genes aimed = step.aim({0.2, 0.1}, parent, smooth(parent));
  EXPECT_EQ(aimed[0], 0.2);
  EXPECT_NEAR(smooth(aimed).objective, 0.98 * smooth(parent).objective, 1e-9);

  // A parent whose objective is twice as high at the same value has to go further.
  Evaluation heavy = smooth(parent);
  heavy.objective *= 2;
  const Genes further = step.aim({0.2, 0.1}, parent, heavy);
  EXPECT_NEAR(2 * smooth(further).objective, 0.98 * smooth(parent).objective, 1e-9);
}

double median_gap(bool with_step) {
  const benchmark::BenchmarkProblem toy = benchmark::staircase();
  std::vector<double> gaps;
  for (std::uint64_t seed = 1; seed <= 21; ++seed) {
    Settings settings;
    settings.budget = 150;
    settings.monotone_step = with_step;
    settings.linear_model = settings.finish = false;
    const auto best = testing_help::run_search(toy, settings, seed);
    EXPECT_TRUE(best->evaluation.feasible()) << "seed " << seed;
    gaps.push_back(best->evaluation.objective - toy.optimum);
  }
  std::nth_element(gaps.begin(), gaps.begin() + 10, gaps.end());
  return gaps[10];
}

// 150 evaluations of the toy of the real job, whose optimum is at 11,644.
TEST(MonotoneStep, EndsSeveralTimesNearerTheOptimumThanWithout) {
  const double with = median_gap(true);
  const double without = median_gap(false);
  RecordProperty("gap_with", std::to_string(with));
  RecordProperty("gap_without", std::to_string(without));
  EXPECT_LT(with, 1800);
  EXPECT_GT(without, 2 * with);
}

}  // namespace
}  // namespace emax
