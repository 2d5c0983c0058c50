#include "host/block_search/block_search.h"

#include <gtest/gtest.h>

#include "host/block_search/simd_evaluator.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

struct Prepared {
  explicit Prepared(const test::Stimulus& s)
      : cloud(s.cloud), mesh(s.mesh(), cloud.normalization()) {}
  PreparedCloud cloud;
  TriangleTree mesh;
};

EmaxResult by_search(const Prepared& p, const SearchOptions& options = {}) {
  SimdEvaluator cpu;
  return search_emax(p.cloud, p.mesh, cpu, options);
}

EmaxResult by_model(const Prepared& p) { return emax_model(p.cloud.points(), p.mesh.records()); }

TEST(EmaxSearch, EqualsTheModelOnEveryStimulus) {
  for (std::uint64_t seed = 50; seed < 54; ++seed) {
    for (const test::Stimulus& s : test::all_stimuli(seed)) {
      SCOPED_TRACE(s.name + ", seed " + std::to_string(seed));
      const Prepared p(s);
      const EmaxResult expected = by_model(p);
      EXPECT_EQ(by_search(p), expected);
      SimdEvaluator cpu;
      EXPECT_EQ(brute_force_emax(p.cloud, p.mesh, cpu), expected);
      const auto nearest = nearest_squared_bits(p.cloud.points(), p.mesh.records());
      EXPECT_EQ(search_nearest(p.cloud, p.mesh, cpu), nearest);
      EXPECT_EQ(brute_force_nearest(p.cloud, p.mesh, cpu), nearest);
    }
  }
}

TEST(EmaxSearch, SendsFarFewerPairsThanBruteForce) {
  const Prepared p(test::bumpy_sphere(60, 80, 20000, 61));
  SimdEvaluator searched, all;
  EXPECT_EQ(search_emax(p.cloud, p.mesh, searched), brute_force_emax(p.cloud, p.mesh, all));
  EXPECT_LT(searched.counters().pairs * 50, all.counters().pairs);
}

TEST(EmaxSearch, ResultDoesNotDependOnDepth) {
  const Prepared p(test::bumpy_sphere(20, 30, 3000, 62));
  SearchOptions shallow, deep;
  shallow.depth = 1;
  deep.depth = 64;
  EXPECT_EQ(by_search(p, shallow), by_search(p, deep));
}

// Without the margin the search drops triangles that the kernel finds nearest.
TEST(EmaxSearchFault, MissingMarginIsCaught) {
  const DeliberateFault fault(Fault::kSearchWithoutMargin);
  int wrong = 0;
  for (std::uint64_t seed = 50; seed < 54; ++seed) {
    for (const test::Stimulus& s : test::all_stimuli(seed)) {
      const Prepared p(s);
      SimdEvaluator cpu;
      wrong += search_nearest(p.cloud, p.mesh, cpu) !=
               nearest_squared_bits(p.cloud.points(), p.mesh.records());
    }
  }
  EXPECT_GT(wrong, 0);
}

// Dropping groups whose bound equals R loses the lowest index of a tie.
TEST(EmaxSearchFault, WrongTieRuleIsCaught) {
  const DeliberateFault fault(Fault::kSearchDropsTies);
  int wrong = 0;
  for (std::uint64_t seed = 50; seed < 54; ++seed) {
    for (const test::Stimulus& s : test::all_stimuli(seed)) {
      const Prepared p(s);
      wrong += !(by_search(p) == by_model(p));
    }
  }
  EXPECT_GT(wrong, 0);
}

TEST(EmaxSearch, StopsWhenInterrupted) {
  const Prepared p(test::bumpy_sphere(20, 30, 3000, 63));
  int asked = 0;
  SearchOptions options;
  options.interrupted = [&asked] { return ++asked > 3; };
  EXPECT_THROW(by_search(p, options), Interrupted);
  SimdEvaluator cpu;
  EXPECT_THROW(brute_force_emax(p.cloud, p.mesh, cpu, options), Interrupted);
}

}  // namespace
}  // namespace emax
