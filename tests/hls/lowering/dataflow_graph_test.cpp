#include "hls/lowering/dataflow_graph.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "hls/lowering/evaluate.h"
#include "tests/hls/lowering/random_graph.h"
#include "tests/hls/lowering/samples.h"

namespace emax {
namespace {

using Sharing = DataflowGraph::Sharing;

std::vector<Word> outputs_of(const DataflowGraph& graph, const std::vector<Word>& inputs) {
  const std::vector<Word> words = evaluate<FlushedFloat>(graph, inputs);
  std::vector<Word> outputs;
  for (const Output& output : graph.outputs()) outputs.push_back(words[output.node]);
  return outputs;
}

// The words of `graph`'s inputs, which may be fewer, by the names of `all`'s.
std::vector<Word> by_name(const DataflowGraph& graph, const DataflowGraph& all,
                          const std::vector<Word>& words) {
  std::vector<Word> chosen;
  for (const Input& input : graph.inputs()) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (all.inputs()[i].name == input.name) chosen.push_back(words[i]);
    }
  }
  return chosen;
}

TEST(DataflowGraph, SharingAndRemovingKeepEveryBit) {
  std::size_t shared_nodes = 0, all_nodes = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const DataflowGraph plain = test::random_graph(random, 60, Sharing::kOff);
    DataflowGraph shared(Sharing::kOn);
    std::vector<NodeId> renamed;
    for (const Node& node : plain.nodes()) {
      std::array<NodeId, 3> operands = node.operands;
      for (NodeId& operand : operands) operand = operand == kNoNode ? kNoNode : renamed[operand];
      if (node.operation == Operation::kInput) {
        renamed.push_back(shared.add_input(plain.inputs()[node.word].name, node.type,
                                           plain.inputs()[node.word].arrival));
      } else if (node.operation == Operation::kConstant) {
        renamed.push_back(shared.add_constant(node.type, node.word));
      } else {
        renamed.push_back(shared.add_operation(node.operation, operands, {}));
      }
    }
    for (const Output& output : plain.outputs()) {
      shared.add_output(output.name, renamed[output.node]);
    }
    shared.remove_dead();
    all_nodes += plain.nodes().size();
    shared_nodes += shared.nodes().size();
    for (int i = 0; i < 100; ++i) {
      std::vector<Word> words;
      for (std::size_t k = 0; k + 1 < plain.inputs().size(); ++k) {
        words.push_back(test::any_word(random));
      }
      words.push_back(random.below(2));
      ASSERT_EQ(outputs_of(shared, by_name(shared, plain, words)), outputs_of(plain, words));
    }
  }
  EXPECT_LT(shared_nodes, all_nodes * 3 / 4);
}

// The rewrites that are made rest on these; those below are not made because they do not hold.
TEST(DataflowGraph, RewritesHoldToTheBit) {
  Random random(2);
  const auto bits = [](FlushedFloat value) { return to_word(value); };
  bool minus_zero_differs = false, times_one_differs = false;
  for (int i = 0; i < 200000; ++i) {
    const FlushedFloat a(to_float(test::any_word(random))), b(to_float(test::any_word(random)));
    const FlushedFloat zero(0.0f), negative_zero(-0.0f), one(1.0f);
    ASSERT_EQ(bits(a + b), bits(b + a));
    ASSERT_EQ(bits(a * b), bits(b * a));
    ASSERT_EQ(a < zero, a < negative_zero);
    ASSERT_EQ(zero < a, negative_zero < a);
    minus_zero_differs = minus_zero_differs || bits(a - zero) != bits(a);
    times_one_differs = times_one_differs || bits(a * one) != bits(a);
  }
  EXPECT_TRUE(minus_zero_differs);
  EXPECT_TRUE(times_one_differs);
}

TEST(DataflowGraph, SharesOnlyWhatIsTheSame) {
  DataflowGraph graph;
  const NodeId a = graph.add_input("a", ValueKind::kReal, Arrival::kSample);
  const NodeId b = graph.add_input("b", ValueKind::kReal, Arrival::kSample);
  const NodeId zero = graph.add_constant(ValueKind::kReal, 0);
  const NodeId one = graph.add_constant(ValueKind::kReal, 0x3f800000);
  const auto add = [&](Operation operation, NodeId x, NodeId y = kNoNode) {
    return graph.add_operation(operation, {x, y, kNoNode}, {});
  };
  EXPECT_EQ(add(Operation::kAdd, a, b), add(Operation::kAdd, b, a));
  EXPECT_EQ(add(Operation::kMultiply, a, b), add(Operation::kMultiply, b, a));
  EXPECT_NE(add(Operation::kSubtract, a, b), add(Operation::kSubtract, b, a));
  EXPECT_NE(add(Operation::kLess, a, b), add(Operation::kLess, b, a));
  EXPECT_EQ(graph.node(add(Operation::kMultiply, a, a)).operation, Operation::kSquare);
  EXPECT_EQ(graph.node(add(Operation::kLess, a, zero)).operation, Operation::kLessZero);
  EXPECT_EQ(graph.node(add(Operation::kLess, zero, a)).operation, Operation::kGreaterZero);
  EXPECT_EQ(graph.node(add(Operation::kSubtract, a, zero)).operation, Operation::kSubtract);
  EXPECT_EQ(graph.node(add(Operation::kMultiply, a, one)).operation, Operation::kMultiply);
  EXPECT_EQ(graph.node(add(Operation::kAdd, one, one)).operation, Operation::kAdd);
  const NodeId less = add(Operation::kLess, a, b);
  EXPECT_EQ(add(Operation::kNegated, add(Operation::kNegated, less)), less);
}

TEST(DataflowGraph, RefusesOperandsThatDoNotFit) {
  DataflowGraph graph;
  const NodeId a = graph.add_input("a", ValueKind::kReal, Arrival::kSample);
  const NodeId w = graph.add_input("w", ValueKind::kWord, Arrival::kSample);
  const auto add = [&](Operation operation, std::array<NodeId, 3> operands) {
    graph.add_operation(operation, operands, {});
  };
  EXPECT_THROW(add(Operation::kAdd, {a, kNoNode, kNoNode}), std::invalid_argument);
  EXPECT_THROW(add(Operation::kAdd, {a, w, kNoNode}), std::invalid_argument);
  EXPECT_THROW(add(Operation::kAdd, {a, a, a}), std::invalid_argument);
  EXPECT_THROW(add(Operation::kSelect, {a, a, a}), std::invalid_argument);
  EXPECT_THROW(add(Operation::kNegated, {99, kNoNode, kNoNode}), std::invalid_argument);
}

}  // namespace
}  // namespace emax
