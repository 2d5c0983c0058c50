#include "host/genocop/operators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <string>

#include "domain_check.h"

namespace emax {

std::ostream& operator<<(std::ostream& out, const OperatorEntry& entry) {
  return out << entry.name;
}

namespace {

using testing_help::broken_rule;
using testing_help::mixed_problem;

class OperatorTest : public testing::TestWithParam<OperatorEntry> {};

TEST_P(OperatorTest, ChildrenStayInsideAndDiffer) {
  constexpr std::uint64_t kSeed = 21;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const Problem problem = mixed_problem();
  const LinearDomain domain(problem);
  int different = 0;
  constexpr int kChildren = 3000;
  for (std::uint64_t i = 0; i < kChildren; ++i) {
    RandomStream random(kSeed, i, RandomStream::Purpose::kTest);
    std::vector<Genes> parents;
    for (std::size_t p = 0; p < GetParam().parents; ++p) parents.push_back(domain.sample(random));
    const OperatorInput input{domain, parents, random.uniform(), 2, 0.1};
    const Genes child = GetParam().apply(input, random);
    ASSERT_EQ(broken_rule(problem, domain.complete(child)), "") << "child " << i;
    different += std::find(parents.begin(), parents.end(), child) == parents.end();
  }
  EXPECT_GT(different, kChildren / 2);
}

TEST_P(OperatorTest, EqualStreamsGiveEqualChildren) {
  const LinearDomain domain(mixed_problem());
  RandomStream source(22, 0, RandomStream::Purpose::kTest);
  std::vector<Genes> parents;
  for (std::size_t p = 0; p < GetParam().parents; ++p) parents.push_back(domain.sample(source));
  const OperatorInput input{domain, parents, 0.5, 2, 0.1};
  std::set<Genes> children;
  for (std::uint64_t i = 0; i < 50; ++i) {
    RandomStream a(22, i, RandomStream::Purpose::kTest), b(22, i, RandomStream::Purpose::kTest);
    const Genes child = GetParam().apply(input, a);
    ASSERT_EQ(child, GetParam().apply(input, b));
    children.insert(child);
  }
  EXPECT_GT(children.size(), 4u);
}

INSTANTIATE_TEST_SUITE_P(Genocop, OperatorTest, testing::ValuesIn(kOperators),
                         [](const auto& param) { return std::string(param.param.name); });

// The rest looks at what each operator does, in a plain box.
struct Box {
  Problem problem;
  LinearDomain domain;
  Box() : problem(make()), domain(problem) {}
  static Problem make() {
    Problem p;
    for (int i = 0; i < 4; ++i) p.genes.push_back({"x", Gene::Kind::kContinuous, -1, 1});
    return p;
  }
};

const Genes kP = {0.1, 0.2, -0.3, 0.4};
const Genes kQ = {-0.5, 0.6, 0.1, -0.2};

int changed(const Genes& a, const Genes& b) {
  int count = 0;
  for (std::size_t k = 0; k < a.size(); ++k) count += a[k] != b[k];
  return count;
}

TEST(Operators, CrossoversStayOnTheirLine) {
  const Box box;
  const std::vector<Genes> parents = {kP, kQ};
  const OperatorInput input{box.domain, parents};
  std::set<int> tails;
  for (std::uint64_t i = 0; i < 200; ++i) {
    RandomStream random(23, i, RandomStream::Purpose::kTest);
    const Genes whole = whole_arithmetical_crossover(input, random);
    const Genes ahead = heuristic_crossover(input, random);
    const double share = (whole[0] - kP[0]) / (kQ[0] - kP[0]);
    const double length = (ahead[0] - kP[0]) / (kP[0] - kQ[0]);
    EXPECT_TRUE(share >= 0 && share <= 1 && length >= 0 && length <= 1);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(whole[k], kP[k] + share * (kQ[k] - kP[k]), 1e-12);
      EXPECT_NEAR(ahead[k], kP[k] + length * (kP[k] - kQ[k]), 1e-12);
    }
    const Genes simple = simple_arithmetical_crossover(input, random);
    EXPECT_EQ(simple[0], kP[0]);
    tails.insert(changed(simple, kP));
  }
  EXPECT_EQ(tails, (std::set<int>{1, 2, 3}));
}

TEST(Operators, MutationsChangeOneGeneOrAll) {
  const Box box;
  const std::vector<Genes> parents = {kP};
  const OperatorInput input{box.domain, parents};
  for (std::uint64_t i = 0; i < 200; ++i) {
    RandomStream random(24, i, RandomStream::Purpose::kTest);
    EXPECT_EQ(changed(uniform_mutation(input, random), kP), 1);
    EXPECT_EQ(changed(non_uniform_mutation(input, random), kP), 1);
    EXPECT_EQ(changed(gaussian_mutation(input, random), kP), 1);
    EXPECT_EQ(changed(whole_uniform_mutation(input, random), kP), 4);
    EXPECT_EQ(changed(whole_non_uniform_mutation(input, random), kP), 4);
    const Genes edge = boundary_mutation(input, random);
    EXPECT_EQ(changed(edge, kP), 1);
    EXPECT_EQ(std::count_if(edge.begin(), edge.end(), [](double x) { return std::abs(x) == 1; }),
              1);
  }
}

TEST(Operators, NonUniformAndGaussianStepsShrinkWithTheBudget) {
  const Box box;
  const std::vector<Genes> parents = {kP};
  const auto mean_step = [&](Operator apply, double remaining) {
    double sum = 0;
    for (std::uint64_t i = 0; i < 500; ++i) {
      RandomStream random(25, i, RandomStream::Purpose::kTest);
      const Genes child = apply({box.domain, parents, remaining, 2, 0.1}, random);
      for (std::size_t k = 0; k < 4; ++k) sum += std::abs(child[k] - kP[k]);
    }
    return sum;
  };
  for (Operator apply : {non_uniform_mutation, whole_non_uniform_mutation}) {
    EXPECT_NEAR(mean_step(apply, 0.5) / mean_step(apply, 1), 0.25, 0.03);
  }
  EXPECT_NEAR(mean_step(gaussian_mutation, 0.5) / mean_step(gaussian_mutation, 1), 0.5, 0.05);
}

// Categories have no order: a child of several parents has one of theirs, a mutant any.
TEST(Operators, CategoriesAreTakenOrChangedNeverMixed) {
  Problem p;
  p.genes = {{"method", Gene::Kind::kCategorical, 0, 9}, {"x", Gene::Kind::kContinuous, 0, 1}};
  const LinearDomain domain(p);
  const std::vector<Genes> parents = {{2, 0.3}, {7, 0.8}, {2, 0.5}, {7, 0.1}};
  for (const OperatorEntry& entry : kOperators) {
    std::set<double> seen;
    for (std::uint64_t i = 0; i < 400; ++i) {
      RandomStream random(31, i, RandomStream::Purpose::kTest);
      const OperatorInput input{domain, std::span(parents).first(entry.parents)};
      seen.insert(entry.apply(input, random)[0]);
    }
    if (entry.parents > 1) {
      for (double category : seen) EXPECT_TRUE(category == 2 || category == 7) << entry.name;
    } else {
      EXPECT_EQ(seen.size(), 10u) << entry.name;
    }
  }
}

TEST(Operators, ManyParents) {
  const Box box;
  const std::vector<Genes> parents = {kP, kQ, {0, 0.3, 0.2, 0.5}, {-0.9, -0.8, -0.7, -0.6}};
  const OperatorInput input{box.domain, parents};
  std::set<double> first_genes;
  for (std::uint64_t i = 0; i < 200; ++i) {
    RandomStream random(26, i, RandomStream::Purpose::kTest);
    const Genes pool = pool_recombination(input, random);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_TRUE(std::any_of(parents.begin(), parents.end(),
                              [&](const Genes& parent) { return parent[k] == pool[k]; }));
    }
    first_genes.insert(pool[0]);
    // Away from the worst: the step from the mean of the others points from worst to mean.
    const Genes reflected = scatter_search(input, random);
    const double mean = (kP[0] + kQ[0] + 0) / 3;
    EXPECT_GE((reflected[0] - mean) * (mean - parents[3][0]), 0);
  }
  EXPECT_EQ(first_genes.size(), 4u);
}

}  // namespace
}  // namespace emax
