#include "host/genocop/repair.h"

#include <gtest/gtest.h>

#include <cmath>

#include "domain_check.h"

namespace emax {
namespace {

Problem line_problem() {
  Problem p;
  p.genes = {{"x", Gene::Kind::kContinuous, 0, 1}};
  return p;
}

// From x = 1 (violation 1 - root) towards x = 0 (violation -root).
struct Trials {
  std::vector<double> shares;
  bool repaired = false;
};

Trials repair(RepairMethod method, double (*violation)(double), int most) {
  const LinearDomain domain(line_problem());
  RepairChain chain(method, {1.0}, violation(1), {0.0}, violation(0));
  RandomStream random(41, 0, RandomStream::Purpose::kTest);
  Trials trials;
  for (int i = 0; i < most && !trials.repaired; ++i) {
    const double x = chain.next(domain, random)[0];
    trials.shares.push_back(x);
    chain.tell({true, 0, violation(x)});
    trials.repaired = violation(x) <= 0;
    EXPECT_EQ(chain.tries(), trials.shares.size());
  }
  return trials;
}

TEST(Repair, DeterministicHalves) {
  const Trials trials = repair(
      RepairMethod::kDeterministic, [](double x) { return x - 0.2; }, 10);
  EXPECT_EQ(trials.shares, (std::vector<double>{0.5, 0.25, 0.125}));
  EXPECT_TRUE(trials.repaired);
}

TEST(Repair, RandomStaysOnTheSegment) {
  const Trials trials = repair(
      RepairMethod::kRandom, [](double x) { return x - 1e-9; }, 200);
  for (double share : trials.shares) EXPECT_TRUE(share >= 0 && share < 1);
  EXPECT_EQ(trials.shares.size(), 200u);
}

TEST(Repair, ValueAwareHitsALinearRootAtOnceAndACurvedOneSoon) {
  const Trials linear = repair(
      RepairMethod::kValueAware, [](double x) { return 2 * x - 1.5; }, 3);
  ASSERT_EQ(linear.shares.size(), 1u);
  EXPECT_NEAR(linear.shares[0], 0.75, 1e-12);

  // Concave: the chord's root is infeasible, so the bracket must shrink from the other side too.
  const auto concave = [](double x) { return std::sqrt(x) - 0.6; };
  const Trials curved = repair(RepairMethod::kValueAware, concave, 3);
  EXPECT_TRUE(curved.repaired);
  EXPECT_GT(curved.shares.back(), 0.15);  // the root is at 0.36
  EXPECT_LE(curved.shares.back(), 0.36);
}

TEST(Repair, AFailedTrialMovesTowardsTheReference) {
  const LinearDomain domain(line_problem());
  RepairChain chain(RepairMethod::kValueAware, {1.0}, 1.0, {0.0}, -1.0);
  RandomStream random(42, 0, RandomStream::Purpose::kTest);
  const double first = chain.next(domain, random)[0];
  chain.tell({false, 0, 0});
  const double second = chain.next(domain, random)[0];
  EXPECT_GT(second, 0);
  EXPECT_LT(second, first);
}

// From category 7 towards 2: no trial has one between them.
TEST(Repair, CategoriesAreThoseOfTheEnds) {
  Problem p;
  p.genes = {{"method", Gene::Kind::kCategorical, 0, 9}, {"x", Gene::Kind::kContinuous, 0, 1}};
  const LinearDomain domain(p);
  RepairChain chain(RepairMethod::kRandom, {7, 1}, 1, {2, 0}, -1);
  RandomStream random(45, 0, RandomStream::Purpose::kTest);
  for (int i = 0; i < 100; ++i) {
    const Genes point = chain.next(domain, random);
    EXPECT_EQ(point[0], point[1] > 0.5 ? 7 : 2);
  }
}

TEST(Repair, TrialsStayInsideDomainAndLinearConstraints) {
  constexpr std::uint64_t kSeed = 43;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const Problem problem = testing_help::mixed_problem();
  const LinearDomain domain(problem);
  for (std::uint64_t i = 0; i < 900; ++i) {
    RandomStream random(kSeed, i, RandomStream::Purpose::kTest);
    const auto method = static_cast<RepairMethod>(i % 3);
    RepairChain chain(method, domain.sample(random), 1, domain.sample(random), -0.5);
    for (int trial = 0; trial < 3; ++trial) {
      const Genes point = chain.next(domain, random);
      ASSERT_EQ(testing_help::broken_rule(problem, domain.complete(point)), "") << i;
      chain.tell({true, 0, random.uniform(-1, 1)});
    }
  }
}

}  // namespace
}  // namespace emax
