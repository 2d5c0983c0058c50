#include "host/genocop/differential_evolution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "benchmark_problems.h"
#include "run_search.h"

namespace emax {
namespace {

using Trial = DifferentialEvolution::Trial;

Problem box(std::size_t genes) {
  Problem p;
  p.genes = benchmark::continuous_genes(genes, -5, 5);
  return p;
}

RandomStream stream(std::uint64_t index) { return {71, index, RandomStream::Purpose::kTest}; }

// Whether three other members explain each gene of the trial that is not its member's.
bool is_explained(const Trial& trial, const std::vector<Genes>& members) {
  const Genes& own = members[trial.member];
  const std::size_t n = members.size();
  for (std::size_t i = 0; i < n * n * n; ++i) {
    const std::size_t a = i / (n * n), b = i / n % n, c = i % n;
    if (a == b || b == c || c == a || a == trial.member || b == trial.member || c == trial.member) {
      continue;
    }
    bool explains = true;
    for (std::size_t k = 0; explains && k < own.size(); ++k) {
      double moved = members[a][k] + 0.5 * (members[b][k] - members[c][k]);
      if (moved > 5) moved = (own[k] + 5) / 2;
      if (moved < -5) moved = (own[k] - 5) / 2;
      explains = trial.free[k] == own[k] || trial.free[k] == moved;
    }
    if (explains) return true;
  }
  return false;
}

TEST(DifferentialEvolution, TrialsMoveOneMemberByTheDifferenceOfTwoOthers) {
  const Problem problem = box(6);
  const LinearDomain domain(problem);
  DifferentialEvolution evolution(domain);
  std::vector<Genes> members(evolution.size());
  std::size_t taken = 0, genes = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    RandomStream random = stream(i);
    const auto trial = evolution.propose([&] { return domain.sample(random); }, random);
    ASSERT_TRUE(trial);
    EXPECT_EQ(trial->member, i % evolution.size());
    if (i >= members.size()) {
      EXPECT_TRUE(is_explained(*trial, members)) << i;
      EXPECT_NE(trial->free, members[trial->member]);
      for (std::size_t k = 0; k < 6; ++k) taken += trial->free[k] == members[trial->member][k];
      genes += 6;
    }
    // Every second trial is better than anything before.
    const bool better = i % 2 == 0 || i < members.size();
    evolution.told(trial->member, trial->free, {true, better ? -double(i) : 1.0, -1});
    if (better) members[trial->member] = trial->free;
  }
  EXPECT_NEAR(static_cast<double>(taken) / static_cast<double>(genes), 0.42, 0.05);
}

// Each kind of result against each other kind, in both orders.
TEST(DifferentialEvolution, FeasibleResultsAreBetterAndOthersCountByTheirViolation) {
  const std::vector<Evaluation> worse_first = {
      {true, 1, 7}, {true, 9, 2}, {true, 8, -1}, {true, 5, -3}};
  const Problem problem = box(3);
  const LinearDomain domain(problem);
  for (std::size_t before = 0; before < worse_first.size(); ++before) {
    for (std::size_t after = 0; after < worse_first.size(); ++after) {
      DifferentialEvolution evolution(domain);
      RandomStream random = stream(100);
      const auto start = [&] { return domain.sample(random); };
      std::vector<Genes> members(evolution.size());
      for (std::size_t i = 0; i < evolution.size(); ++i) {
        const auto trial = evolution.propose(start, random);
        members[trial->member] = trial->free;
        evolution.told(trial->member, trial->free, worse_first[before]);
      }
      const auto trial = evolution.propose(start, random);
      evolution.told(trial->member, trial->free, worse_first[after]);
      // The member that was replaced is met again in later trials.
      bool met = false;
      for (int i = 0; i < 400; ++i) {
        const auto later = evolution.propose(start, random);
        for (std::size_t k = 0; k < 3; ++k) {
          met = met || (later->member == trial->member && later->free[k] == trial->free[k] &&
                        trial->free[k] != members[trial->member][k]);
        }
        evolution.told(later->member, later->free, {true, 100, 100});
      }
      EXPECT_EQ(met, after >= before) << before << ' ' << after;
    }
  }
}

TEST(DifferentialEvolution, FailuresTakeNoPlaceAndStartsAreMadeAnew) {
  const Problem problem = box(3);
  const LinearDomain domain(problem);
  DifferentialEvolution evolution(domain);
  RandomStream random = stream(200);
  std::size_t starts = 0;
  const auto start = [&] {
    ++starts;
    return domain.sample(random);
  };
  for (std::size_t i = 0; i < 2 * evolution.size(); ++i) {
    const auto trial = evolution.propose(start, random);
    evolution.told(trial->member, trial->free, Evaluation{});
  }
  EXPECT_EQ(starts, 2 * evolution.size());
  // Where a single member is known, no trial can be made of it, but the others are still asked for.
  const auto first = evolution.propose(start, random);
  evolution.told(first->member, first->free, {true, 1, -1});
  for (std::size_t i = 1; i < evolution.size(); ++i) {
    EXPECT_TRUE(evolution.propose(start, random));
  }
  EXPECT_FALSE(evolution.propose(start, random));
  EXPECT_TRUE(evolution.propose(start, random));
}

// 3^10 local optima; also that a population which has become one point begins anew.
TEST(DifferentialEvolution, FindsTheOptimumAmongManyAndBeginsAnew) {
  const Problem problem = box(10);
  const LinearDomain domain(problem);
  DifferentialEvolution evolution(domain);
  double best = HUGE_VAL;
  std::size_t starts = 0;
  for (std::uint64_t i = 0; i < 60'000; ++i) {
    RandomStream random = stream(i);
    const auto trial = evolution.propose(
        [&] {
          ++starts;
          return domain.sample(random);
        },
        random);
    double sum = 0;
    for (const double x : trial->free) {
      sum += x * x + 10 * (1 - std::cos(2 * std::numbers::pi * x));
    }
    best = std::min(best, sum);
    evolution.told(trial->member, trial->free, {true, sum, -1});
  }
  EXPECT_LT(best, 1e-6);
  EXPECT_GT(starts, evolution.size());
}

TEST(DifferentialEvolution, LeadsASearchWithManyGenesOutOfLocalOptima) {
  std::vector<double> with, without;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Settings settings;
    settings.budget = 4000;
    settings.look_ahead = 1;
    const benchmark::BenchmarkProblem bench = benchmark::g02();
    with.push_back(testing_help::run_search(bench, settings, seed)->evaluation.objective);
    settings.differential = false;
    without.push_back(testing_help::run_search(bench, settings, seed)->evaluation.objective);
  }
  std::ranges::sort(with);
  std::ranges::sort(without);
  EXPECT_LT(with[1], without[1] - 0.1);
}

}  // namespace
}  // namespace emax
