#include <gtest/gtest.h>

#include <algorithm>

#include "host/genocop/linear_domain.h"
#include "host/genocop/linear_step.h"
#include "host/genocop/operators.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Kind = Gene::Kind;

// Two methods: one with two parameters, one with five.
Problem two_methods() {
  Problem p;
  p.genes = {{"method", Kind::kCategorical, 0, 1},
             {"a0", Kind::kContinuous, 0, 1, Gene::Condition{0, 0}},
             {"a1", Kind::kContinuous, 0, 1, Gene::Condition{0, 0}}};
  for (int i = 0; i < 5; ++i) {
    p.genes.push_back({"b", Kind::kContinuous, 0, 1, Gene::Condition{0, 1}});
  }
  return p;
}

TEST(ConditionalGenes, RefuseConditionsThatNameNoCategory) {
  using Condition = Gene::Condition;
  for (const Condition& wrong : {Condition{99, 0}, Condition{2, 0}, Condition{0, 0.5}}) {
    Problem p = two_methods();
    p.genes[1].only_with = wrong;
    EXPECT_THROW(LinearDomain{p}, Error) << wrong.gene << ' ' << wrong.category;
  }
  Problem chained = two_methods();
  chained.genes.push_back({"detail", Kind::kCategorical, 0, 1, Condition{0, 0}});
  chained.genes.push_back({"c", Kind::kContinuous, 0, 1, Condition{8, 0}});
  EXPECT_THROW(LinearDomain{chained}, Error);
  Problem narrowed = two_methods();
  narrowed.genes[0].upper = 0;
  EXPECT_NO_THROW(LinearDomain{narrowed});
}

TEST(ConditionalGenes, MayNameTheCategoryThatTheyAreWithout) {
  Problem p;
  p.genes = {{"fill", Kind::kCategorical, 0, 2},
             {"size", Kind::kContinuous, 0, 1, Gene::Condition{0, 0, true}}};
  const LinearDomain domain(p);
  EXPECT_FALSE(domain.has_meaning({0, 0.5}, 1));
  EXPECT_TRUE(domain.has_meaning({1, 0.5}, 1));
  EXPECT_TRUE(domain.has_meaning({2, 0.5}, 1));
  EXPECT_EQ(domain.movable_with_meaning({0, 0.5}), std::vector<std::size_t>{0});
}

TEST(ConditionalGenes, MutationsOfOneGeneChangeOneThatCounts) {
  const LinearDomain domain(two_methods());
  RandomStream random(31, 0, RandomStream::Purpose::kTest);
  for (const auto mutation :
       {uniform_mutation, boundary_mutation, non_uniform_mutation, gaussian_mutation}) {
    for (int i = 0; i < 200; ++i) {
      const std::vector<Genes> parents = {domain.sample(random)};
      const Genes child = mutation({domain, parents, 0.9, 2, 0.1}, random);
      for (std::size_t k = 0; k < child.size(); ++k) {
        EXPECT_TRUE(child[k] == parents[0][k] || domain.has_meaning(parents[0], k)) << k;
      }
    }
  }
}

// Three points span a plane of the first method, whatever the second method's genes are.
TEST(ConditionalGenes, ALinearModelHasTheGenesOfItsMethodAlone) {
  const Problem p = two_methods();
  const LinearDomain domain(p);
  LinearStep step(domain, p, {1, 2, 3, 4, 5, 6, 7});
  RandomStream random(32, 0, RandomStream::Purpose::kTest);
  const auto evaluate = [](const Genes& g) { return Evaluation{true, g[1] + 2 * g[2], -1}; };
  Genes best;
  for (int i = 0; i < 4; ++i) {
    Genes point = domain.sample(random);
    point[0] = 0;
    step.told(point, evaluate(point));
    if (best.empty() || evaluate(point).objective < evaluate(best).objective) best = point;
  }
  const auto next = step.propose(best, evaluate(best), random);
  ASSERT_TRUE(next);
  EXPECT_LT(evaluate(*next).objective, evaluate(best).objective);
  EXPECT_TRUE(std::equal(next->begin() + 3, next->end(), best.begin() + 3));
  Genes other = best;
  other[0] = 1;
  EXPECT_FALSE(step.propose(other, evaluate(other), random));
}

}  // namespace
}  // namespace emax
