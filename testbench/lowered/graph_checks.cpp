#include "testbench/lowered/graph_checks.h"

#include <algorithm>
#include <cstdio>

#include "hls/lowering/evaluate.h"
#include "testbench/lowered/graph_mutants.h"

namespace emax {
namespace {

using Kinds = std::vector<std::pair<std::string_view, long>>;

bool can_be_flushed(Operation operation) {
  return operation == Operation::kInput ||
         (operation >= Operation::kAdd && operation <= Operation::kDivide);
}

Kinds kinds_of(const Node& node) {
  if (node.type.kind == ValueKind::kCondition) return {{"false", 0}, {"true", 0}};
  if (node.type.kind == ValueKind::kFixed) {
    return {{"least", 0}, {"negative", 0}, {"zero", 0}, {"positive", 0}, {"greatest", 0}};
  }
  Kinds kinds = {{"zero", 0}, {"positive", 0}, {"infinite", 0}, {"NaN", 0}};
  const Operation operation = node.operation;
  const bool has_sign = operation != Operation::kSquare && operation != Operation::kSquareRoot &&
                        operation != Operation::kMagnitude;
  if (has_sign) kinds.insert(kinds.begin(), {"negative", 0});
  if (can_be_flushed(operation)) kinds.emplace_back("flushed", 0);
  return kinds;
}

std::string_view kind_of_fixed(const ValueType& type, Bits bits) {
  const Bits sign = Bits{1} << (type.width - 1);
  if (bits == sign) return "least";
  if (bits == sign - 1) return "greatest";
  return bits == 0 ? "zero" : bits > sign ? "negative" : "positive";
}

bool is_zero(const BinaryFormat& format, Bits bits) {
  return (bits & (format.sign() - 1)) < format.least_normal();
}

// Whether a result that is zero would not be with more bits of exponent.
bool is_flushed(const Node& node, const std::vector<Bits>& values) {
  const BinaryFormat format = node.type.binary();
  const Bits magnitude = format.sign() - 1;
  const Bits a = values[node.operands[0]];
  const Bits b = info(node.operation).operands > 1 ? values[node.operands[1]] : a;
  switch (node.operation) {
    case Operation::kAdd:
    case Operation::kSubtract:
      return !(is_zero(format, a) && is_zero(format, b)) && (a & magnitude) != (b & magnitude);
    case Operation::kDivide:
      return !is_zero(format, a) && (b & magnitude) != format.infinity();
    default:
      return !is_zero(format, a) && !is_zero(format, b);
  }
}

std::string_view kind_of_binary(const DataflowGraph& graph, NodeId id,
                                const std::vector<Bits>& values) {
  const Node& node = graph.node(id);
  const BinaryFormat format = node.type.binary();
  const Bits bits = values[id], magnitude = bits & (format.sign() - 1);
  if (is_zero(format, bits)) {
    if (node.operation == Operation::kInput) return magnitude != 0 ? "flushed" : "zero";
    return can_be_flushed(node.operation) && is_flushed(node, values) ? "flushed" : "zero";
  }
  if (magnitude >= format.infinity()) return magnitude > format.infinity() ? "NaN" : "infinite";
  return bits != magnitude ? "negative" : "positive";
}

std::string_view kind_of(const DataflowGraph& graph, NodeId id, const std::vector<Bits>& values) {
  const ValueType& type = graph.node(id).type;
  if (type.kind == ValueKind::kCondition) return values[id] != 0 ? "true" : "false";
  if (type.kind == ValueKind::kFixed) return kind_of_fixed(type, values[id]);
  return kind_of_binary(graph, id, values);
}

// The number of the first sample from which a graph gives other results than these; -1 if none
// does. The graph takes a sample and the next one, which is itself after the last.
std::int64_t first_difference(const DataflowGraph& graph, const BenchSamples& samples,
                              const BenchSamples& results) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<Bits> inputs = samples[i];
    const std::vector<Bits>& next = samples[std::min(i + 1, samples.size() - 1)];
    inputs.insert(inputs.end(), next.begin(), next.end());
    const std::vector<Bits> values = evaluate<FlushedFloat, Bits>(graph, inputs);
    for (std::size_t k = 0; k < results[i].size(); ++k) {
      if (values[graph.outputs()[k].node] != results[i][k]) return static_cast<std::int64_t>(i);
    }
  }
  return -1;
}

BenchSamples results_of(const FunctionModel& model, const BenchSamples& samples) {
  BenchSamples results;
  for (const std::vector<Bits>& sample : samples) results.push_back(model.call(sample));
  return results;
}

bool is_function(std::string_view name, const LoweredDesign& design, const FunctionModel& model,
                 const BenchSamples& samples) {
  const std::int64_t sample =
      first_difference(faultless_copy(design), samples, results_of(model, samples));
  if (sample < 0) return true;
  std::printf("%.*s: the graph gives other results than the function for sample %lld\n",
              static_cast<int>(name.size()), name.data(), static_cast<long long>(sample));
  return false;
}

std::string kinds_in_words(const Kinds& kinds) {
  std::string reached, never;
  for (const auto& [kind, count] : kinds) {
    std::string& list = count > 0 ? reached : never;
    list += (list.empty() ? "" : ", ") + std::string(kind);
    if (count > 0) list += " " + std::to_string(count);
  }
  return reached + (never.empty() ? "" : (reached.empty() ? "never " : "; never ") + never);
}

struct Reached {
  long values = 0, kinds = 0, reached = 0;

  void add(const Kinds& of) {
    ++values;
    kinds += static_cast<long>(of.size());
    reached += std::ranges::count_if(of, [](const auto& entry) { return entry.second > 0; });
  }
};

}  // namespace

std::vector<ValueCoverage> graph_coverage(const LoweredDesign& design,
                                          const BenchSamples& samples) {
  std::vector<ValueCoverage> coverage;
  for (NodeId id = 0; id < design.graph.nodes().size(); ++id) {
    const Node& node = design.graph.node(id);
    if (node.operation != Operation::kConstant) coverage.push_back({id, kinds_of(node)});
  }
  for (const std::vector<Bits>& sample : samples) {
    const std::vector<Bits> values = evaluate<FlushedFloat, Bits>(design.graph, sample);
    for (ValueCoverage& value : coverage) {
      const std::string_view kind = kind_of(design.graph, value.node, values);
      const auto entry = std::ranges::find(value.kinds, kind, &Kinds::value_type::first);
      if (entry != value.kinds.end()) ++entry->second;
    }
  }
  return coverage;
}

std::vector<MutantResult> run_graph_mutants(const LoweredDesign& design, const FunctionModel& model,
                                            const BenchSamples& samples) {
  const BenchSamples results = results_of(model, samples);
  std::vector<MutantResult> mutants;
  for (const GraphMutant& mutant : graph_mutants(design)) {
    mutants.push_back({mutant.what, first_difference(mutant.graph, samples, results)});
  }
  return mutants;
}

int print_coverage(std::string_view name, const LoweredDesign& design, const FunctionModel& model,
                   const BenchSamples& samples) {
  if (!is_function(name, design, model, samples)) return 1;
  Reached conditions, numbers;
  for (const ValueCoverage& value : graph_coverage(design, samples)) {
    const bool condition = design.graph.node(value.node).type.kind == ValueKind::kCondition;
    (condition ? conditions : numbers).add(value.kinds);
    std::printf("%s: %s\n", described_value(design, value.node).c_str(),
                kinds_in_words(value.kinds).c_str());
  }
  std::printf(
      "%.*s: coverage: %ld of %ld outcomes of conditions, %ld of %ld kinds of numbers (%ld and %ld "
      "values)\n",
      static_cast<int>(name.size()), name.data(), conditions.reached, conditions.kinds,
      numbers.reached, numbers.kinds, conditions.values, numbers.values);
  return 0;
}

int print_mutants(std::string_view name, const LoweredDesign& design, const FunctionModel& model,
                  const BenchSamples& samples) {
  if (!is_function(name, design, model, samples)) return 1;
  const std::vector<MutantResult> mutants = run_graph_mutants(design, model, samples);
  long noticed = 0;
  for (const MutantResult& mutant : mutants) {
    noticed += mutant.sample >= 0;
    if (mutant.sample >= 0) {
      std::printf("%s: noticed by sample %lld\n", mutant.what.c_str(),
                  static_cast<long long>(mutant.sample));
    } else {
      std::printf("%s: not noticed\n", mutant.what.c_str());
    }
  }
  std::printf("%.*s: mutants: the samples notice %ld of %zu\n", static_cast<int>(name.size()),
              name.data(), noticed, mutants.size());
  return noticed > 0 ? 0 : 1;
}

}  // namespace emax
