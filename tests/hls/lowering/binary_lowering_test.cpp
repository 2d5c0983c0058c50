// Other binary formats than binary32 in the graph: what is recorded, its types, its values beside
// the function, and its text.
#include <gtest/gtest.h>

#include <regex>
#include <stdexcept>

#include "hls/lowering/evaluate.h"
#include "hls/lowering/function_subject.h"
#include "hls/lowering/graph_json.h"
#include "hls/lowering/opencl.h"
#include "hls/lowering/systemverilog.h"
#include "testbench/lowered/bench_samples.h"
#include "testbench/lowered/function_bench.h"
#include "tests/hls/lowering/functions/every_operator.h"
#include "tests/hls/lowering/module_text.h"

namespace emax {
namespace {

constexpr const char* kEveryOperator =
    EMAX_PROJECT "/tests/hls/lowering/functions/every_operator.h";

using Half = Binary<5, 10>;
using Brain = Binary<8, 7>;
using Widest = Binary<10, 23>;

template <class Number>
LoweredDesign every_operator_on(const LoweringOptions& options = {}) {
  return EMAX_FUNCTION_ON(every_operator, kEveryOperator, Number).lower(options);
}

// The number of results of a function, of `samples` calls, that evaluation of a graph does not
// give.
template <class Number>
long unlike_function(const DataflowGraph& graph, int samples) {
  const FunctionModel model = on_words(&every_operator<Number>);
  BenchOptions options;
  options.samples = samples;
  long wrong = 0;
  for (const std::vector<Bits>& sample : drawn_samples("binary graphs", model, options)) {
    const std::vector<Bits> values = evaluate<FlushedFloat, Bits>(graph, sample);
    const std::vector<Bits> results = model.call(sample);
    for (std::size_t k = 0; k < results.size(); ++k) {
      wrong += values[graph.outputs()[k].node] != results[k];
    }
  }
  return wrong;
}

TEST(BinaryLowering, GraphGivesTheFunctionsNumbers) {
  EXPECT_EQ(unlike_function<Half>(every_operator_on<Half>().graph, 50000), 0);
  EXPECT_EQ(unlike_function<Brain>(every_operator_on<Brain>().graph, 50000), 0);
  EXPECT_EQ(unlike_function<Widest>(every_operator_on<Widest>().graph, 50000), 0);
}

TEST(BinaryLoweringFault, AnotherFormatIsNoticed) {
  EXPECT_GT(unlike_function<Brain>(every_operator_on<Half>().graph, 1000), 0);
}

TEST(BinaryLowering, Binary32IsTheSameByAnotherName) {
  const LoweredDesign single = EMAX_FUNCTION(every_operator, kEveryOperator).lower({});
  EXPECT_EQ(datapath_module(every_operator_on<Binary<8, 23>>()), datapath_module(single));
  EXPECT_EQ(opencl_function(every_operator_on<Binary<8, 23>>()), opencl_function(single));
}

TEST(BinaryLowering, TextHasTheFormat) {
  const std::string half = datapath_module(every_operator_on<Half>());
  EXPECT_EQ(test::fault_of_module(half), "");
  constexpr const char* kParts[] = {
      R"(input  logic \[15:0\] in_a)",
      R"(localparam logic \[15:0\] WORD_3400 = 16'h3400;)",
      R"(fp_add #\(.EXPONENT\(5\), .MANTISSA\(10\), .LATENCY\(ADD_LATENCY\)\) \w+_adder)",
      R"(fp_square_root #\(.EXPONENT\(5\), .MANTISSA\(10\), .LATENCY)",
      R"(\{~(\w+)\[15\], \1\[14:0\]\})",
      R"(\{1'b0, \w+\[14:0\]\})",
      R"( ~(\w+)\[15\] & \|\1\[14:10\] & ~\(&\1\[14:10\] & \|\1\[9:0\]\);)",
      R"( (\w+)\[15\] & \|\1\[14:10\];)",
      R"( ~(\w+)\[15\] & \|\1\[14:10\] & ~\(&\1\[14:9\]\);)"};
  for (const char* part : kParts) {
    EXPECT_TRUE(std::regex_search(half, std::regex(part))) << part << "\n" << half;
  }
  EXPECT_EQ(half.find("[31:0]"), std::string::npos);
  EXPECT_EQ(test::fault_of_module(datapath_module(every_operator_on<Widest>())), "");
  const std::string json = graph_json(every_operator_on<Brain>());
  EXPECT_NE(json.find("\"exponent\": 8, \"mantissa\": 7}"), std::string::npos);
}

TEST(BinaryLowering, DivisionTakesACycleADigit) {
  EXPECT_EQ(every_operator_on<Half>().options.latencies.divide, 14);
  EXPECT_EQ(every_operator_on<Half>().options.latencies.square_root, 13);
  LoweringOptions options;
  options.latencies.divide = 14;
  options.latencies.square_root = 5;
  EXPECT_EQ(every_operator_on<Half>(options).options.latencies.square_root, 5);
  options.latencies.divide = 15;
  EXPECT_THROW(every_operator_on<Half>(options), std::invalid_argument);
  EXPECT_EQ(every_operator_on<Widest>(options).options.latencies.divide, 15);
  EXPECT_EQ(every_operator_on<Widest>().options.latencies.divide, 27);
}

TEST(BinaryLowering, NumbersThatMeetHaveOneFormat) {
  DataflowGraph graph;
  const NodeId half = graph.add_input("a", ValueType(Half::format()), Arrival::kSample);
  const NodeId brain = graph.add_input("b", ValueType(Brain::format()), Arrival::kSample);
  const NodeId single = graph.add_input("c", ValueKind::kReal, Arrival::kSample);
  const auto add = [&](NodeId x, NodeId y) {
    return graph.add_operation(Operation::kAdd, {x, y, kNoNode}, {});
  };
  EXPECT_THROW(add(half, brain), std::invalid_argument);
  EXPECT_THROW(add(half, single), std::invalid_argument);
  EXPECT_THROW(add(single, brain), std::invalid_argument);
  EXPECT_EQ(graph.node(add(brain, brain)).type, ValueType(Brain::format()));
}

TEST(BinaryLowering, ComparisonWithEitherZeroIsOneOfSign) {
  DataflowGraph graph;
  const NodeId a = graph.add_input("a", ValueType(Half::format()), Arrival::kSample);
  for (const Bits zero : {Bits{0}, Half::format().sign()}) {
    const NodeId constant = graph.add_constant(ValueType(Half::format()), zero);
    const NodeId less = graph.add_operation(Operation::kLess, {a, constant, kNoNode}, {});
    EXPECT_EQ(graph.node(less).operation, Operation::kLessZero);
  }
}

TEST(BinaryLowering, OpenclIsForBinary32) {
  EXPECT_THROW(opencl_function(every_operator_on<Half>()), std::invalid_argument);
}

}  // namespace
}  // namespace emax
