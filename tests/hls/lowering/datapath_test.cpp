#include <Vlowered_distance.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <array>
#include <string>
#include <vector>

#include "hls/lowering/designs.h"
#include "hls/lowering/evaluate.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/model/flushed_float.h"
#include "tests/hls/lowering/samples.h"

namespace emax {
namespace {

using Datapath = Vlowered_distance;

// Drives the datapath with a new sample every cycle, each input at its own cycle, and compares
// every node at its ready cycle. Returns the first node that differs, `late` cycles after its ready
// cycle, as a message; empty if none does.
std::string first_difference(const LoweredDesign& design, const std::vector<test::Sample>& drawn,
                             int late) {
  std::vector<std::vector<Word>> samples, expected;
  for (const test::Sample& sample : drawn) {
    samples.push_back(test::input_words(design.graph, sample));
    expected.push_back(evaluate<FlushedFloat>(design.graph, samples.back()));
  }
  VerilatedContext context;
  Datapath datapath(&context);
  const auto in_range = [&](int sample) {
    return sample >= 0 && sample < static_cast<int>(samples.size());
  };
  const auto ports = std::to_array<IData*>({&datapath.p_x,
                                            &datapath.p_y,
                                            &datapath.p_z,
                                            &datapath.t_v1_x,
                                            &datapath.t_v1_y,
                                            &datapath.t_v1_z,
                                            &datapath.t_normal_x,
                                            &datapath.t_normal_y,
                                            &datapath.t_normal_z,
                                            &datapath.t_in_plane_x,
                                            &datapath.t_in_plane_y,
                                            &datapath.t_in_plane_z,
                                            &datapath.t_along_x,
                                            &datapath.t_along_y,
                                            &datapath.t_along_z,
                                            &datapath.t_length12,
                                            &datapath.t_edge13_direction_y,
                                            &datapath.t_edge13_direction_z,
                                            &datapath.t_edge13_length,
                                            &datapath.t_edge23_direction_y,
                                            &datapath.t_edge23_direction_z,
                                            &datapath.t_edge23_length});
  const auto& inputs = design.graph.inputs();
  if (inputs.size() != ports.size() + 1) return "the datapath has other inputs";
  for (int cycle = 0; cycle < static_cast<int>(samples.size()) + design.schedule.latency; ++cycle) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const int sample = cycle - design.schedule.start[inputs[i].node];
      const Word word = in_range(sample) ? samples[static_cast<std::size_t>(sample)][i] : 0;
      if (i < ports.size()) {
        *ports[i] = word;
      } else {
        datapath.segment = word != 0;
      }
    }
    datapath.clk = 0;
    datapath.eval();
    for (std::size_t i = 0; i < design.probes.size(); ++i) {
      const NodeId node = design.probes[i];
      const int sample = cycle - design.schedule.ready[node] - late;
      if (!in_range(sample)) continue;
      const Word word = expected[static_cast<std::size_t>(sample)][node];
      if (datapath.probes[i] != word) {
        return design.graph.node(node).name + " of sample " + std::to_string(sample) + ": " +
               describe_bits(datapath.probes[i]) + ", model " + describe_bits(word);
      }
    }
    datapath.clk = 1;
    datapath.eval();
  }
  return "";
}

TEST(Datapath, GivesEveryNodesValueAtItsCycle) {
  const auto samples = test::record_samples(41, 20000);
  EXPECT_EQ(first_difference(emax_distance_design(), samples, 0), "") << "seed 41";
}

TEST(Datapath, ComparisonSeesOneCycleOfDifference) {
  const auto samples = test::record_samples(42, 200);
  EXPECT_NE(first_difference(emax_distance_design(), samples, 1), "");
}

}  // namespace
}  // namespace emax
