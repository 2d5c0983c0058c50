// Fixed-point numbers in the graph: what is recorded, its types, and its values beside the
// function.
#include <gtest/gtest.h>

#include <stdexcept>

#include "hls/lowering/evaluate.h"
#include "hls/lowering/function_subject.h"
#include "hls/lowering/opencl.h"
#include "hls/lowering/recorded_fixed.h"
#include "testbench/lowered/function_bench.h"
#include "testbench/stimuli/random.h"
#include "tests/hls/lowering/functions/every_fixed_operator.h"
#include "tests/hls/lowering/functions/fixed_distance.h"

namespace emax {
namespace {

constexpr const char* kOperatorsHeader =
    EMAX_PROJECT "/tests/hls/lowering/functions/every_fixed_operator.h";
constexpr const char* kDistanceHeader =
    EMAX_PROJECT "/tests/hls/lowering/functions/fixed_distance.h";

// The number of samples whose outputs, by evaluation of the graph, are not the function's.
long differences(const DataflowGraph& graph, const FunctionModel& model, int samples) {
  Random random(named_seed("fixed-point graphs", 1));
  long wrong = 0;
  for (int i = 0; i < samples; ++i) {
    std::vector<Bits> inputs;
    for (const ValueType& type : model.arguments) {
      const auto bits =
          static_cast<Bits>(static_cast<std::int64_t>(random.bits()) >> random.below(64));
      inputs.push_back(bits & ((Bits{1} << type.width) - 1));
    }
    const std::vector<Bits> values = evaluate<FlushedFloat, Bits>(graph, inputs);
    const std::vector<Bits> results = model.call(inputs);
    for (std::size_t k = 0; k < results.size(); ++k) {
      wrong += values[graph.outputs()[k].node] != results[k];
    }
  }
  return wrong;
}

using Nearest = Fixed<18, 16>;
using Wrapping = Fixed<25, 9, Rounding::kDown, Overflow::kWrap>;

TEST(FixedLowering, GraphGivesTheFunctionsNumbers) {
  const LoweredDesign nearest =
      EMAX_FUNCTION_ON(every_fixed_operator, kOperatorsHeader, Nearest).lower({});
  EXPECT_EQ(differences(nearest.graph, on_words(&every_fixed_operator<Nearest>), 50000), 0);
  const LoweredDesign wrapping =
      EMAX_FUNCTION_ON(every_fixed_operator, kOperatorsHeader, Wrapping).lower({});
  EXPECT_EQ(differences(wrapping.graph, on_words(&every_fixed_operator<Wrapping>), 50000), 0);
  const LoweredDesign distance =
      EMAX_FUNCTION_ON(fixed_distance, kDistanceHeader, Nearest).lower({});
  EXPECT_EQ(differences(distance.graph, on_words(&fixed_distance<Nearest>), 50000), 0);
}

TEST(FixedLoweringFault, AnotherFormatIsNoticed) {
  const LoweredDesign distance =
      EMAX_FUNCTION_ON(fixed_distance, kDistanceHeader, Nearest).lower({});
  using Down = Fixed<18, 16, Rounding::kDown>;
  EXPECT_GT(differences(distance.graph, on_words(&fixed_distance<Down>), 1000), 0);
}

TEST(FixedLowering, DistanceHasTheOperationsOfTheKernel) {
  const LoweredDesign fixed = EMAX_FUNCTION_ON(fixed_distance, kDistanceHeader, Nearest).lower({});
  const LoweredDesign real = lower(Form::kVisibleEdge, {});
  EXPECT_EQ(fixed.graph.count(Operation::kFixedMultiply),
            real.graph.count(Operation::kMultiply) + real.graph.count(Operation::kSquare));
  EXPECT_EQ(fixed.graph.count(Operation::kFixedAdd), real.graph.count(Operation::kAdd));
  EXPECT_EQ(fixed.graph.count(Operation::kFixedSubtract), real.graph.count(Operation::kSubtract));
  EXPECT_EQ(fixed.graph.count(Operation::kSelect), real.graph.count(Operation::kSelect));
}

class FixedGraph : public ::testing::Test {
 protected:
  template <class Number>
  NodeId input() {
    return graph_.add_input("a", ValueType(Number::format()), Arrival::kSample);
  }
  // The operation that a change of format from one to another becomes.
  template <class From, class To>
  Operation fit() {
    const NodeId fitted = graph_.add_operation(
        Operation::kFixedFit, {input<From>(), kNoNode, kNoNode}, {}, ValueType(To::format()));
    return graph_.node(fitted).operation;
  }

  DataflowGraph graph_;
};

TEST_F(FixedGraph, ChangesOfFormatWithoutArithmeticAreWires) {
  constexpr auto kDown = Rounding::kDown;
  constexpr auto kWrap = Overflow::kWrap;
  EXPECT_EQ((fit<Fixed<18, 16>, Fixed<20, 17>>()), Operation::kFixedWires);
  EXPECT_EQ((fit<Fixed<18, 16>, Fixed<18, 16, kDown, kWrap>>()), Operation::kFixedWires);
  EXPECT_EQ((fit<Fixed<18, 16>, Fixed<8, 4, kDown, kWrap>>()), Operation::kFixedWires);
  EXPECT_EQ((fit<Fixed<18, 16>, Fixed<18, 15, kDown>>()), Operation::kFixedWires);
  EXPECT_EQ((fit<Fixed<18, 16>, Fixed<18, 15>>()), Operation::kFixedFit);
  EXPECT_EQ((fit<Fixed<18, 16>, Fixed<18, 17, kDown>>()), Operation::kFixedFit);
}

TEST_F(FixedGraph, NumbersThatMeetHaveOneFormat) {
  const NodeId a = input<Fixed<18, 16>>(), b = input<Fixed<18, 15>>();
  const NodeId real = graph_.add_input("r", ValueKind::kReal, Arrival::kSample);
  const auto add = [&](Operation operation, NodeId x, NodeId y,
                       std::optional<ValueType> result = {}) {
    return graph_.add_operation(operation, {x, y, kNoNode}, {}, result);
  };
  EXPECT_THROW(add(Operation::kFixedAdd, a, b), std::invalid_argument);
  EXPECT_THROW(add(Operation::kFixedLess, a, b), std::invalid_argument);
  EXPECT_THROW(add(Operation::kFixedAdd, a, real), std::invalid_argument);
  EXPECT_THROW(add(Operation::kAdd, real, a), std::invalid_argument);
  EXPECT_THROW(add(Operation::kFixedMultiply, a, b), std::invalid_argument);
  EXPECT_THROW(add(Operation::kFixedMultiply, a, b, ValueType(ValueKind::kReal)),
               std::invalid_argument);
  EXPECT_THROW(add(Operation::kFixedAdd, a, a, ValueType(Fixed<18, 16>::format())),
               std::invalid_argument);
  EXPECT_NO_THROW(add(Operation::kFixedMultiply, a, b, ValueType(Fixed<36, 31>::format())));
  EXPECT_NO_THROW(add(Operation::kFixedAdd, a, a));
}

TEST(FixedLowering, OpenclRefusesFixedPointNumbers) {
  const LoweredDesign design = EMAX_FUNCTION_ON(fixed_distance, kDistanceHeader, Nearest).lower({});
  EXPECT_THROW(opencl_function(design), std::invalid_argument);
}

}  // namespace
}  // namespace emax
