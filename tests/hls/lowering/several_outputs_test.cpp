// A generated module with outputs that are ready in different cycles, simulated.
#include <Vlowered_several_outputs.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "hls/lowering/evaluate.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/model/flushed_float.h"
#include "tests/hls/lowering/random_graph.h"
#include "tests/hls/lowering/samples.h"

namespace emax {
namespace {

// Drives a new sample every cycle, each input at its own cycle, and compares every output `late`
// cycles after the last is ready. Returns the first difference; empty if there is none.
std::string first_difference(std::uint64_t seed, int late) {
  const LoweredDesign design = test::several_outputs_design();
  constexpr int kCalls = 20000;
  Random random(seed);
  std::vector<std::array<Word, 2>> samples;
  std::vector<std::vector<Word>> expected;
  for (int i = 0; i < kCalls; ++i) {
    samples.push_back({test::any_word(random), test::any_word(random)});
    expected.push_back(evaluate<FlushedFloat>(design.graph, samples.back()));
  }
  VerilatedContext context;
  Vlowered_several_outputs module(&context);
  const std::array<IData*, 2> inputs = {&module.dist_value, &module.cross_value};
  const auto outputs = [&] {
    return std::vector<Word>{module.early, module.later, module.local_value, module.early_again,
                             module.through};
  };
  const int latency = design.schedule.latency;
  for (int cycle = 0; cycle < kCalls + latency; ++cycle) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const int sample = cycle - design.schedule.start[design.graph.inputs()[i].node];
      const bool in_range = sample >= 0 && sample < kCalls;
      *inputs[i] = in_range ? samples[static_cast<std::size_t>(sample)][i] : 0;
    }
    module.clk = 0;
    module.eval();
    if (const int sample = cycle - latency - late; sample >= 0) {
      const auto& words = expected[static_cast<std::size_t>(sample)];
      for (std::size_t i = 0; i < outputs().size(); ++i) {
        const Word word = words[design.graph.outputs()[i].node];
        if (outputs()[i] == word) continue;
        return design.graph.outputs()[i].name + " of sample " + std::to_string(sample) + ": " +
               describe_bits(outputs()[i]) + ", model " + describe_bits(word);
      }
    }
    module.clk = 1;
    module.eval();
  }
  return "";
}

TEST(SeveralOutputs, AreAllThereInTheLastCycle) {
  EXPECT_EQ(first_difference(43, 0), "") << "seed 43";
}

TEST(SeveralOutputs, ComparisonSeesOneCycleOfDifference) { EXPECT_NE(first_difference(43, 1), ""); }

}  // namespace
}  // namespace emax
