#include "host/genocop/linear_domain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "domain_check.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using testing_help::broken_rule;
using testing_help::mixed_problem;
using Kind = Gene::Kind;
using Relation = LinearConstraint::Relation;

Problem triangle() {  // x + y <= 1 in the unit square
  Problem p;
  p.genes = {{"x", Kind::kContinuous, 0, 1}, {"y", Kind::kContinuous, 0, 1}};
  p.linear = {{{{0, 1.0}, {1, 1.0}}, Relation::kAtMost, 1.0}};
  return p;
}

TEST(DomainCheck, CatchesEveryKindOfFault) {
  const Problem p = mixed_problem();
  Genes good = {1, 0, 3, 0, 3, 4.5, 2};
  ASSERT_EQ(broken_rule(p, good), "");
  const auto broken = [&](std::size_t gene, double value) {
    Genes bad = good;
    bad[gene] = value;
    return broken_rule(p, bad);
  };
  EXPECT_EQ(broken(1, 5.0000001), "domain of b");
  EXPECT_EQ(broken(1, std::nan("")), "domain of b");
  EXPECT_EQ(broken(2, 3.5), "n not whole");
  EXPECT_EQ(broken(2, 2), "inequality");
  EXPECT_EQ(broken(5, 4.50001), "equality");
}

TEST(LinearDomain, SamplesStayInsideAndRoundTrip) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const Problem p = mixed_problem();
  const LinearDomain domain(p);
  EXPECT_EQ(domain.size(), 6u);  // one gene is solved for
  for (std::uint64_t i = 0; i < 2000; ++i) {
    RandomStream random(kSeed, i, RandomStream::Purpose::kTest);
    const Genes free = domain.sample(random);
    const Genes genes = domain.complete(free);
    ASSERT_EQ(broken_rule(p, genes), "") << "sample " << i;
    ASSERT_EQ(domain.reduce(genes), free);
    ASSERT_TRUE(domain.contains(free));
  }
}

// Where every other gene stays: the twin walks the domain in small steps.
TEST(LinearDomain, RangeAgreesWithScanning) {
  constexpr std::uint64_t kSeed = 12;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const LinearDomain domain(mixed_problem());
  for (std::uint64_t i = 0; i < 50; ++i) {
    RandomStream random(kSeed, i, RandomStream::Purpose::kTest);
    const Genes point = domain.sample(random);
    for (std::size_t k : domain.movable()) {
      const Interval range = domain.range(point, k);
      const Gene& gene = domain.gene(k);
      const bool integer = gene.kind == Kind::kInteger;
      const double step = integer ? 1 : (gene.upper - gene.lower) / 512;
      for (double value = gene.lower; value <= gene.upper; value += step) {
        const double margin = integer ? 0 : 1e-9;
        Genes moved = point;
        moved[k] = value;
        if (value >= range.lower + margin && value <= range.upper - margin) {
          ASSERT_TRUE(domain.contains(moved)) << "point " << i << " gene " << k << " at " << value;
        } else if (value < range.lower - margin || value > range.upper + margin) {
          ASSERT_FALSE(domain.contains(moved)) << "point " << i << " gene " << k << " at " << value;
        }
      }
    }
  }
}

TEST(LinearDomain, PullInsideStopsAtTheBoundary) {
  const LinearDomain domain(triangle());
  const Genes point = domain.pull_inside({0.9, 0.9}, {0.1, 0.1});
  EXPECT_TRUE(domain.contains(point));
  EXPECT_NEAR(point[0], 0.5, 1e-12);
  EXPECT_NEAR(point[1], 0.5, 1e-12);
  EXPECT_EQ(domain.pull_inside({0.25, 0.5}, {0.1, 0.1}), (Genes{0.25, 0.5}));  // inside: untouched
}

TEST(LinearDomain, PullInsideEndsInsideFromAnywhere) {
  constexpr std::uint64_t kSeed = 13;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const Problem p = mixed_problem();
  const LinearDomain domain(p);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    RandomStream random(kSeed, i, RandomStream::Purpose::kTest);
    const Genes anchor = domain.sample(random);
    Genes child(anchor.size());
    for (double& c : child) c = random.uniform(-20, 20);
    ASSERT_EQ(broken_rule(p, domain.complete(domain.pull_inside(child, anchor))), "") << i;
  }
}

TEST(LinearDomain, RefusesWhatHoldsNoPoint) {
  Problem p = triangle();
  p.linear.push_back({{{0, -1.0}, {1, -1.0}}, Relation::kAtMost, -1.5});
  EXPECT_THROW(LinearDomain{p}, Error);

  p = triangle();
  p.genes[0].lower = 2;
  EXPECT_THROW(LinearDomain{p}, Error);

  p = triangle();
  p.genes[0] = {"x", Kind::kInteger, 0.2, 0.8};
  EXPECT_THROW(LinearDomain{p}, Error);

  p = triangle();
  p.starts = {{0.9, 0.9}};
  EXPECT_THROW(LinearDomain{p}, Error);

  p = triangle();
  p.linear = {{{{0, 1.0}, {1, 1.0}}, Relation::kEqual, 1.0},
              {{{0, 2.0}, {1, 2.0}}, Relation::kEqual, 1.0}};
  EXPECT_THROW(LinearDomain{p}, Error);

  p = triangle();
  for (Gene& gene : p.genes) gene.kind = Kind::kInteger;
  p.linear = {{{{0, 1.0}, {1, 1.0}}, Relation::kEqual, 1.0}};
  EXPECT_THROW(LinearDomain{p}, Error);
}

TEST(LinearDomain, RefusesCategoriesInLinearConstraints) {
  Problem p = triangle();
  p.genes[1] = {"method", Kind::kCategorical, 0, 3};
  EXPECT_THROW(LinearDomain{p}, Error);
}

TEST(LinearDomain, RefusesWhatNamesNoGene) {
  Problem p = triangle();
  p.linear.push_back({{{p.genes.size(), 1.0}}, Relation::kAtMost, 1.0});
  EXPECT_THROW(LinearDomain{p}, Error);
  for (const std::size_t length : {p.genes.size() - 1, p.genes.size() + 1}) {
    p = triangle();
    p.starts = {Genes(length, 0.1)};
    EXPECT_THROW(LinearDomain{p}, Error);
  }
  p = triangle();
  p.monotone_gene = p.genes.size();
  EXPECT_THROW(LinearDomain{p}, Error);
  p = triangle();
  p.linear.clear();
  p.genes[1] = {"method", Kind::kCategorical, 0, 3};
  EXPECT_NO_THROW(LinearDomain{p});
  p.monotone_gene = 1;
  EXPECT_THROW(LinearDomain{p}, Error);
}

TEST(LinearDomain, AnEqualityThatFollowsFromOthersIsDropped) {
  Problem p = triangle();
  p.linear = {{{{0, 1.0}, {1, 1.0}}, Relation::kEqual, 1.0},
              {{{0, 2.0}, {1, 2.0}}, Relation::kEqual, 2.0}};
  const LinearDomain domain(p);
  EXPECT_EQ(domain.size(), 1u);
  RandomStream random(14, 0, RandomStream::Purpose::kTest);
  EXPECT_EQ(broken_rule(p, domain.complete(domain.sample(random))), "");
}

// Thin, far from the middle of the box, and cutting off most of it.
TEST(LinearDomain, FindsASmallCorner) {
  Problem p;
  for (int i = 0; i < 6; ++i) p.genes.push_back({"x", Kind::kContinuous, 0, 100});
  LinearConstraint sum{{}, Relation::kAtMost, 0.01};
  for (std::size_t i = 0; i < 6; ++i) sum.terms.emplace_back(i, 1.0);
  p.linear = {sum, {{{0, 1.0}, {1, -1.0}}, Relation::kAtMost, 0}};
  const LinearDomain domain(p);
  EXPECT_EQ(broken_rule(p, domain.complete(domain.inside())), "");
}

}  // namespace
}  // namespace emax
