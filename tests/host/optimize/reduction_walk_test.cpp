#include "host/optimize/reduction_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using Function = std::function<double(double)>;

struct Walked {
  int trials = 0;
  double best = -1;  // value of the best that holds; -1 where none does
};

Walked walk(const Function& violation, double lower = 0, double upper = 0.98) {
  ReductionWalk walk(lower, upper);
  Walked walked;
  while (const std::optional<double> value = walk.next()) {
    EXPECT_GE(*value, lower);
    EXPECT_LE(*value, upper);
    EXPECT_EQ(walk.next(), value);  // until it is told
    const double v = violation(*value);
    const auto triangles = static_cast<std::size_t>(70000 * (1 - *value));
    walk.told(std::isfinite(v), triangles, v);
    if (v <= 0) walked.best = std::max(walked.best, *value);
    ++walked.trials;
  }
  return walked;
}

// The twin is the zero that was put there.
TEST(ReductionWalk, FindsWhereTheBoundIsMet) {
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const double zero = random.uniform(0.3, 0.95), steep = random.uniform(1, 12),
                 rough = random.uniform(0, 0.02);
    const Function violation = [&](double r) {
      return std::expm1(steep * (r - zero)) + rough * std::sin(300 * r);
    };
    if (violation(0) > 0) continue;
    const Walked walked = walk(violation);
    EXPECT_LE(walked.trials, ReductionWalk::kMostTrials) << i;
    EXPECT_GE(walked.best, zero - 0.06) << i << " zero " << zero;
  }
}

TEST(ReductionWalk, AFloorThatBreaksTheBoundIsOneTrial) {
  const Walked walked = walk([](double r) { return 0.1 + r; });
  EXPECT_EQ(walked.trials, 1);
  EXPECT_EQ(walked.best, -1);
  EXPECT_EQ(walk([](double) { return std::nan(""); }).trials, 1);
}

TEST(ReductionWalk, GoesToTheEndWhereNothingBreaksTheBound) {
  const Walked walked = walk([](double) { return -0.5; }, 0.2, 0.9);
  EXPECT_GT(walked.best, 0.899);
}

// Trials that fail are as good as ones that break the bound.
TEST(ReductionWalk, StaysBelowWhatFails) {
  const Walked walked = walk([](double r) { return r > 0.6 ? std::nan("") : -0.1; });
  EXPECT_LE(walked.best, 0.6);
  EXPECT_GT(walked.best, 0.5);
}

}  // namespace
}  // namespace emax::test
