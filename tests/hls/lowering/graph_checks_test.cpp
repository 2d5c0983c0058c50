// What is said of a testbench's samples: the outcomes that they reach, the faults that they show.
#include "testbench/lowered/graph_checks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hls/lowering/function_subject.h"
#include "testbench/lowered/bench_samples.h"
#include "testbench/lowered/graph_mutants.h"
#include "tests/hls/lowering/functions/every_fixed_operator.h"
#include "tests/hls/lowering/functions/every_operator.h"
#include "tests/hls/lowering/functions/signs_alone.h"

namespace emax {
namespace {

constexpr const char* kFunctions = EMAX_PROJECT "/tests/hls/lowering/functions/";

const std::string& header_of(const std::string& function) {
  static std::map<std::string, std::string> headers;
  return headers.try_emplace(function, kFunctions + function + ".h").first->second;
}

struct Subject {
  LoweredDesign design;
  FunctionModel model;

  BenchSamples samples(int count) const {
    BenchOptions options;
    options.samples = count;
    return drawn_samples("graph checks", model, options);
  }
  std::vector<std::string> not_noticed(const BenchSamples& samples) const {
    std::vector<std::string> list;
    for (const MutantResult& mutant : run_graph_mutants(design, model, samples)) {
      if (mutant.sample < 0) list.push_back(mutant.what);
    }
    return list;
  }
};

Subject signs_subject() {
  return {EMAX_FUNCTION(signs_alone, header_of("signs_alone")).lower({}),
          on_words(&signs_alone<FlushedFloat>)};
}
Subject operators_subject() {
  return {EMAX_FUNCTION(every_operator, header_of("every_operator")).lower({}),
          on_words(&every_operator<FlushedFloat>)};
}
Subject fixed_subject() {
  using Number = Fixed<18, 16>;
  return {
      EMAX_FUNCTION_ON(every_fixed_operator, header_of("every_fixed_operator"), Number).lower({}),
      on_words(&every_fixed_operator<Number>)};
}

// The one that is left computes the same: `both` of a condition and another beside its negation.
TEST(GraphMutants, SamplesOfEveryOperatorShowEveryFault) {
  EXPECT_TRUE(signs_subject().not_noticed(signs_subject().samples(20000)).empty());
  EXPECT_TRUE(fixed_subject().not_noticed(fixed_subject().samples(20000)).empty());
  const std::vector<std::string> same =
      operators_subject().not_noticed(operators_subject().samples(20000));
  ASSERT_EQ(same.size(), 1);
  EXPECT_NE(same[0].find("the second condition alone"), std::string::npos) << same[0];
}

// Every operation has a fault of its own, and every delay.
TEST(GraphMutants, EveryOperationHasAFault) {
  for (const Subject& subject : {operators_subject(), fixed_subject()}) {
    const std::vector<GraphMutant> mutants = graph_mutants(subject.design);
    for (NodeId id = 0; id < subject.design.graph.nodes().size(); ++id) {
      const Operation operation = subject.design.graph.node(id).operation;
      if (!subject.design.graph.is_operation(id) || operation == Operation::kFixedWires) continue;
      const std::string value = described_value(subject.design, id);
      const bool exact =
          operation == Operation::kFixedFit || operation == Operation::kFixedMultiply;
      EXPECT_TRUE(exact || std::ranges::any_of(mutants,
                                               [&](const GraphMutant& mutant) {
                                                 return mutant.what.starts_with(value + ": ") &&
                                                        mutant.what.find("a cycle early") ==
                                                            std::string::npos;
                                               }))
          << value;
    }
  }
}

TEST(GraphMutantsFault, PoorSamplesLetFaultsPass) {
  const Subject subject = signs_subject();
  const BenchSamples same(100, subject.samples(1)[0]);
  const std::vector<std::string> unseen = subject.not_noticed(same);
  // Nothing that comes a cycle early is another value.
  const auto early = std::ranges::count_if(unseen, [](const std::string& what) {
    return what.find("a cycle early") != std::string::npos;
  });
  const auto delays =
      std::ranges::count_if(graph_mutants(subject.design), [](const GraphMutant& mutant) {
        return mutant.what.find("a cycle early") != std::string::npos;
      });
  EXPECT_GT(delays, 0);
  EXPECT_EQ(early, delays);
  EXPECT_GT(unseen.size(), static_cast<std::size_t>(delays));
}

TEST(GraphMutantsFault, AnotherFunctionIsNoticed) {
  const Subject subject = signs_subject();
  FunctionModel other = subject.model;
  other.call = [&](std::span<const Bits> bits) {
    std::vector<Bits> results = subject.model.call(bits);
    results[0] ^= bits[0] & 1u;
    return results;
  };
  EXPECT_EQ(print_mutants("signs", subject.design, subject.model, subject.samples(100)), 0);
  EXPECT_EQ(print_mutants("signs", subject.design, other, subject.samples(100)), 1);
  EXPECT_EQ(print_coverage("signs", subject.design, other, subject.samples(100)), 1);
  // Without a sample no fault is noticed.
  EXPECT_EQ(print_mutants("signs", subject.design, subject.model, {}), 1);
}

TEST(GraphCoverage, CountsTheKindsOfEveryValue) {
  const Subject subject = signs_subject();
  const auto word = [](float value) { return Bits{to_word(FlushedFloat(value))}; };
  const auto kinds = [&](const BenchSamples& samples, const std::string& of) {
    for (const ValueCoverage& value : graph_coverage(subject.design, samples)) {
      const Node& node = subject.design.graph.node(value.node);
      if (node.name != of && info(node.operation).name != of) continue;
      std::string text;
      for (const auto& [kind, count] : value.kinds) {
        if (count > 0) text += std::string(kind) + " " + std::to_string(count) + " ";
      }
      return text;
    }
    return std::string("no such value");
  };
  const Bits one = word(1), tiny = word(0x1p-100f), subnormal = 1, infinite = word(INFINITY),
             nan = 0x7fc00000;
  const BenchSamples ordinary = {{one, one, one, one}, {one, word(-2), one, one}};
  EXPECT_EQ(kinds(ordinary, "a"), "positive 2 ");
  EXPECT_EQ(kinds(ordinary, "multiply"), "negative 1 positive 1 ");
  EXPECT_EQ(kinds(ordinary, "less_zero"), "false 1 true 1 ");
  EXPECT_EQ(kinds(ordinary, "subtract"), "zero 1 positive 1 ");
  const BenchSamples special = {{tiny, tiny, one, one},
                                {subnormal, one, one, one},
                                {infinite, 0, one, one},
                                {nan, infinite, one, one}};
  EXPECT_EQ(kinds(special, "a"), "positive 1 infinite 1 NaN 1 flushed 1 ");
  EXPECT_EQ(kinds(special, "multiply"), "zero 1 NaN 2 flushed 1 ");
}

}  // namespace
}  // namespace emax
