#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "hls/kernel/forms/three_edge.h"
#include "hls/kernel/reduce.h"
#include "hls/lowering/designs.h"
#include "hls/lowering/evaluate.h"
#include "hls/lowering/graph_json.h"
#include "hls/lowering/report.h"
#include "hls/lowering/systemverilog.h"
#include "tests/hls/lowering/samples.h"

namespace emax {
namespace {

constexpr std::size_t kSamples = 100000;

Word evaluated(const LoweredDesign& design, const std::vector<Word>& inputs) {
  return evaluate<FlushedFloat>(design.graph, inputs)[design.graph.outputs()[0].node];
}

template <class Record, class Direct>
void expect_same_bits(Form form, const std::vector<test::Sample>& samples, Direct direct) {
  const LoweredDesign design = lower(form, {});
  ASSERT_GE(samples.size(), kSamples);
  std::size_t ordinary = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool segment = (samples[i].record[kRecordWords - 1] & kSegmentFlag) != 0;
    const Word expected = to_word(
        direct(test::flushed_record<Record>(samples[i]), segment, test::flushed_point(samples[i])));
    ordinary += is_finite_bits(expected) && expected != 0 ? 1 : 0;
    ASSERT_EQ(evaluated(design, test::input_words(design.graph, samples[i])), expected)
        << "sample " << i;
  }
  EXPECT_GT(ordinary, samples.size() / 3);
}

TEST(Lowering, VisibleEdgeKeepsEveryBit) {
  expect_same_bits<TriangleRecord<FlushedFloat>>(
      Form::kVisibleEdge, test::record_samples(31, kSamples),
      [](const auto& t, bool segment, const auto& p) { return squared_distance(t, segment, p); });
}

TEST(Lowering, ThreeEdgeKeepsEveryBit) {
  expect_same_bits<TriangleRecord<FlushedFloat>>(
      Form::kThreeEdge, test::record_samples(32, kSamples),
      [](const auto& t, bool segment, const auto& p) {
        return squared_distance_three_edge(t, segment, p);
      });
}

TEST(Lowering, BarycentricKeepsEveryBit) {
  expect_same_bits<BarycentricRecord<FlushedFloat>>(
      Form::kBarycentric, test::barycentric_samples(33, kSamples),
      [](const auto& t, bool segment, const auto& p) {
        return squared_distance_barycentric(t, segment, p);
      });
}

TEST(Lowering, ReductionsKeepEveryBit) {
  const LoweredDesign least = lower(Form::kMinimum, {}), greatest = lower(Form::kMaximum, {});
  Random random(34);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Word a = random.word(), b = random.one_in(8) ? a : random.word();
    const Word index_a = random.word(), index_b = random.word();
    ASSERT_EQ(evaluated(least, {a, b}), minimum(a, b));
    const auto words = evaluate<FlushedFloat>(greatest.graph, std::vector{a, index_a, b, index_b});
    const auto expected = maximum(WorstPoint<Word>{a, index_a}, WorstPoint<Word>{b, index_b});
    ASSERT_EQ(words[greatest.graph.outputs()[0].node], expected.squared_distance);
    ASSERT_EQ(words[greatest.graph.outputs()[1].node], expected.index);
  }
}

TEST(Lowering, FormsCostTheOperationsTheirHeadersState) {
  const auto multiplications = [](const DataflowGraph& graph) {
    return graph.count(Operation::kMultiply) + graph.count(Operation::kSquare);
  };
  const auto additions = [](const DataflowGraph& graph) {
    return graph.count(Operation::kAdd) + graph.count(Operation::kSubtract);
  };
  const DataflowGraph& visible = emax_distance_design().graph;
  EXPECT_EQ(multiplications(visible), 20u);
  EXPECT_EQ(visible.count(Operation::kSquare), 3u);
  EXPECT_EQ(additions(visible), 18u);
  const DataflowGraph three = lower(Form::kThreeEdge, {}).graph;
  EXPECT_EQ(multiplications(three), 24u);
  EXPECT_EQ(additions(three), 20u);
  EXPECT_GT(multiplications(lower(Form::kBarycentric, {}).graph), 24u);
}

TEST(Lowering, NodesAreNamedAfterTheSource) {
  const DataflowGraph& graph = emax_distance_design().graph;
  std::set<std::string> names;
  for (const Node& node : graph.nodes()) {
    if (node.operation == Operation::kConstant) continue;
    EXPECT_TRUE(std::regex_match(node.name, std::regex("[a-z][a-z0-9_]*"))) << node.name;
    EXPECT_TRUE(names.insert(node.name).second) << node.name << " twice";
  }
  for (const char* name : {"q_x",
                           "q_z",
                           "x",
                           "y",
                           "z",
                           "z_from_v2",
                           "along13",
                           "along13_product",
                           "along13_product_2",
                           "across23",
                           "along23_minus_length",
                           "residual12",
                           "residual13",
                           "residual23",
                           "visible12",
                           "prefer23",
                           "across_upper",
                           "prefer_upper",
                           "outside",
                           "off_plane",
                           "in_plane",
                           "squared_distance",
                           "t_edge13_direction_y",
                           "segment"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

// Fields are read at one cycle each, so that nothing of a record waits in registers.
TEST(Lowering, NoRecordFieldIsDelayed) {
  const LoweredDesign& design = emax_distance_design();
  for (const Input& input : design.graph.inputs()) {
    if (input.arrival == Arrival::kSample) continue;
    EXPECT_EQ(design.schedule.last_use[input.node], design.schedule.ready[input.node])
        << input.name;
  }
  EXPECT_EQ(design.graph.inputs().size(), 3u + 20u);
}

TEST(Lowering, OptionsReachTheText) {
  LoweringOptions options;
  options.module = "other";
  options.latencies.add = 7;
  options.delays = delay_styles(Family::kXilinx);
  const LoweredDesign design = lower(Form::kThreeEdge, options);
  const std::string text = datapath_module(design);
  EXPECT_NE(text.find("module other (\n"), std::string::npos);
  EXPECT_NE(text.find("ADD_LATENCY = 7;"), std::string::npos);
  EXPECT_NE(text.find("\"shift_register\""), std::string::npos);
  EXPECT_EQ(text.find("distributed_ram"), std::string::npos);
  EXPECT_NE(unit_module(design).find("module other_unit #("), std::string::npos);
  EXPECT_NE(schedule_header(design).find("`define OTHER_LATENCY " +
                                         std::to_string(design.schedule.latency)),
            std::string::npos);
  EXPECT_THROW(unit_module(lower(Form::kMinimum, {})), std::invalid_argument);
}

TEST(Lowering, ReportAndGraphNameEveryNode) {
  const LoweredDesign& design = emax_distance_design();
  const std::string report = report_json(design), dot = dot_graph(design);
  EXPECT_NE(report.find("\"multiplications\": 20, \"additions\": 18, \"latency\": " +
                        std::to_string(design.schedule.latency)),
            std::string::npos)
      << report;
  for (const NodeId node : design.probes) {
    EXPECT_NE(dot.find("\n    \"" + design.graph.node(node).name + "\" [label="),
              std::string::npos);
  }
  EXPECT_EQ(std::count(dot.begin(), dot.end(), '{'), std::count(dot.begin(), dot.end(), '}'));
}

TEST(Lowering, GraphAsJsonHasEveryNodeOperandAndCycle) {
  const LoweredDesign& design = emax_distance_design();
  const std::string json = graph_json(design);
  std::size_t from = 0;
  for (NodeId id = 0; id < design.graph.nodes().size(); ++id) {
    const Node& node = design.graph.node(id);
    std::string operands;
    for (const NodeId operand : design.graph.operands(id)) {
      operands += (operands.empty() ? "" : ", ") + std::to_string(operand);
    }
    const std::string line =
        "{\"operation\": \"" + std::string(info(node.operation).name) + "\", \"name\": \"" +
        node.name + "\", \"width\": " + std::to_string(node.type.width) + ", \"operands\": [" +
        operands + "], \"word\": " + std::to_string(node.word) +
        ", \"start\": " + std::to_string(design.schedule.start[id]) +
        ", \"ready\": " + std::to_string(design.schedule.ready[id]) + "}";
    from = json.find(line, from);
    ASSERT_NE(from, std::string::npos) << line;
  }
  EXPECT_NE(json.find("\"outputs\": [{\"name\": \"squared_distance\", \"node\": " +
                      std::to_string(design.graph.outputs().front().node) + "}]}"),
            std::string::npos);
}

TEST(Lowering, DelayStylesFollowTheirThresholds) {
  const DelayStyles styles{2, 8, 66, "distributed_ram"};
  EXPECT_EQ(styles.style(32, 2), "registers");
  EXPECT_EQ(styles.style(32, 3), "distributed_ram");
  EXPECT_EQ(styles.style(32, 66), "distributed_ram");
  EXPECT_EQ(styles.style(32, 67), "block_ram");
  EXPECT_EQ(styles.style(1, 8), "registers");
  EXPECT_EQ(styles.style(1, 67), "distributed_ram");
}

}  // namespace
}  // namespace emax
