#include <gtest/gtest.h>

#include "Vevery_latency_rtl.h"
#include "testbench/operators/operator_stimuli.h"

namespace emax {
namespace {

constexpr int kSettled = 20;  // cycles after which all that comes out was put in

struct Differences {
  unsigned add = 0, multiply = 0, square = 0, less = 0;
};

// Which latencies differed at any time while random pairs of every aim went through.
Differences run(bool fault, std::uint64_t seed) {
  VerilatedContext context;
  Vevery_latency_rtl rtl(&context);
  Random random(seed);
  std::vector<OperandPair> pairs = corner_pairs(), more(2000);
  for (int aim = 0; aim < kAims; ++aim) {
    fill_pairs(static_cast<Aim>(aim), random, more);
    pairs.insert(pairs.end(), more.begin(), more.end());
  }
  Differences differences;
  rtl.fault = fault;
  int cycle = 0;
  for (const OperandPair& pair : pairs) {
    rtl.a = pair.a;
    rtl.b = pair.b;
    rtl.clk = 0;
    rtl.eval();
    rtl.clk = 1;
    rtl.eval();
    if (++cycle < kSettled) continue;
    differences.add |= rtl.add_differs;
    differences.multiply |= rtl.multiply_differs;
    differences.square |= rtl.square_differs;
    differences.less |= rtl.less_differs;
  }
  return differences;
}

TEST(OperatorLatency, ResultsAreTheSameAtEveryLatency) {
  const std::uint64_t seed = named_seed("ResultsAreTheSameAtEveryLatency", 1);
  const Differences differences = run(false, seed);
  EXPECT_EQ(differences.add, 0u) << "bit LATENCY - 1, seed " << seed;
  EXPECT_EQ(differences.multiply, 0u) << "bit LATENCY - 2, seed " << seed;
  EXPECT_EQ(differences.square, 0u) << "bit LATENCY - 2, seed " << seed;
  EXPECT_EQ(differences.less, 0u) << "bit LATENCY - 1, seed " << seed;
}

TEST(OperatorLatency, FaultIsSeenAtEveryLatency) {
  const Differences differences = run(true, named_seed("FaultIsSeenAtEveryLatency", 1));
  EXPECT_EQ(differences.add, (1u << 14) - 1);
  EXPECT_EQ(differences.multiply, (1u << 12) - 1);
  EXPECT_EQ(differences.square, (1u << 12) - 1);
  EXPECT_EQ(differences.less, (1u << 6) - 1);
}

}  // namespace
}  // namespace emax
