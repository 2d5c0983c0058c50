#include "host/genocop/finish.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "benchmark_problems.h"
#include "domain_check.h"

namespace emax {
namespace {

struct Outcome {
  Evaluation best;  // of the merit: may break a constraint by rounding
  Genes genes;
  int evaluations = 0;
  bool ended = false;
};

Outcome finish(const Problem& problem, const std::function<Evaluation(const Genes&)>& evaluate,
               const Genes& start, int budget) {
  const LinearDomain domain(problem);
  Finish search(domain, problem, domain.movable());
  search.start(start, evaluate(start), 0.1);
  Outcome outcome;
  while (outcome.evaluations < budget) {
    const std::optional<Genes> trial = search.propose();
    if (!trial) break;
    EXPECT_EQ(testing_help::broken_rule(problem, domain.complete(*trial)), "");
    search.asked(*trial);
    search.told(*trial, evaluate(*trial));
    ++outcome.evaluations;
  }
  outcome.ended = !search.running();
  outcome.genes = *search.centre();
  outcome.best = evaluate(outcome.genes);
  return outcome;
}

// From the middle of the domain to the known optimum of the functions that have one.
TEST(Finish, ReachesTheOptimumOfSmoothFunctions) {
  for (const auto& bench :
       {benchmark::g04(), benchmark::g05(), benchmark::g07(), benchmark::g10(), benchmark::g11()}) {
    SCOPED_TRACE(bench.name);
    const LinearDomain domain(bench.problem);
    const Outcome outcome = finish(bench.problem, bench.evaluate, domain.inside(), 600);
    EXPECT_NEAR(outcome.best.objective, bench.optimum,
                1e-4 * std::max(1.0, std::abs(bench.optimum)));
    EXPECT_LT(outcome.best.violation, 1e-6);
    EXPECT_TRUE(outcome.ended);
  }
}

// A constraint may be told in any unit.
TEST(Finish, ConstraintsOfOtherScalesCostNoTrials) {
  for (const auto& bench : {benchmark::g05(), benchmark::g07(), benchmark::g10()}) {
    SCOPED_TRACE(bench.name);
    const Genes start = LinearDomain(bench.problem).inside();
    const Outcome outcome = finish(bench.problem, bench.evaluate, start, 600);
    Problem scaled = bench.problem;
    const auto factor = [](std::size_t c) { return c % 2 == 0 ? 1e4 : 1e-3; };
    for (std::size_t c = 0; c < scaled.nonlinear.size(); ++c) {
      scaled.nonlinear[c].tolerance *= factor(c);
    }
    const auto evaluate = [&](const Genes& g) {
      const Evaluation e = bench.evaluate(g);
      std::vector<double> values = e.constraints;
      for (std::size_t c = 0; c < values.size(); ++c) values[c] *= factor(c);
      return make_evaluation(scaled.nonlinear, e.objective, values);
    };
    const Outcome other = finish(scaled, evaluate, start, 600);
    EXPECT_NEAR(other.best.objective, bench.optimum, 1e-4 * std::max(1.0, std::abs(bench.optimum)));
    EXPECT_TRUE(other.ended);
    EXPECT_LT(other.evaluations, 3 * outcome.evaluations / 2);
  }
}

TEST(Finish, WithoutConstraintsAQuadraticBowlTakesFewTrials) {
  Problem p;
  p.genes = benchmark::continuous_genes(6, -1, 1);
  const auto bowl = [](const Genes& g) {
    double sum = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      sum += static_cast<double>(i + 1) * (g[i] - 0.3) * (g[i] - 0.3);
    }
    return Evaluation{true, sum, -1};
  };
  const Outcome outcome = finish(p, bowl, Genes(6, -0.8), 400);
  EXPECT_LT(outcome.best.objective, 1e-8);
  EXPECT_LT(outcome.evaluations, 250);
}

TEST(Finish, FailedEvaluationsOnlyShortenTheSteps) {
  const auto bench = benchmark::g06();
  const auto fails_somewhere = [&](const Genes& g) {
    return g[0] > 16 ? Evaluation{} : bench.evaluate(g);
  };
  const Outcome outcome = finish(bench.problem, fails_somewhere, {15, 5}, 400);
  EXPECT_NEAR(outcome.best.objective, bench.optimum, 0.7);
}

// A deliberate fault: with the sign of one constraint wrong the search must not end where it
// should.
TEST(Finish, AWrongConstraintIsSeenInTheResult) {
  const auto bench = benchmark::g06();
  const auto wrong = [&](const Genes& g) {
    Evaluation e = bench.evaluate(g);
    return make_evaluation(bench.problem.nonlinear, e.objective,
                           {-e.constraints[0], e.constraints[1]});
  };
  const Outcome outcome = finish(bench.problem, wrong, {15, 5}, 400);
  EXPECT_GT(std::abs(outcome.best.objective - bench.optimum), 1.0);
}

// Points of others that lie near serve the models: fewer trials are needed.
TEST(Finish, NeedsNoTrialsWhereOthersWereMade) {
  const auto bench = benchmark::g04();
  const LinearDomain domain(bench.problem);
  Finish search(domain, bench.problem, domain.movable());
  const Genes start = domain.inside();
  search.start(start, bench.evaluate(start), 0.1);
  for (std::size_t k = 0; k < start.size(); ++k) {
    Genes near = start;
    near[k] += 0.1 * (domain.gene(k).upper - domain.gene(k).lower);
    search.told(near, bench.evaluate(near));
  }
  const Genes trial = *search.propose();
  int moved = 0;
  for (std::size_t k = 0; k < start.size(); ++k) moved += trial[k] != start[k];
  EXPECT_GT(moved, 2);  // a step of the model, not one more direction
}

}  // namespace
}  // namespace emax
