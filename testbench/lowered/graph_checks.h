// What the samples of a lowered function's testbench are worth: which outcomes they reach in its
// dataflow graph, and which faults they would show. Both compare the graph with the function first:
// the pipeline, which the testbench compares on the same samples, computes what the graph does.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hls/lowering/designs.h"
#include "testbench/lowered/function_bench.h"

namespace emax {

using BenchSamples = std::vector<std::vector<Bits>>;

// How often a value was of each kind that it can be: false and true of a condition; negative, zero,
// positive, infinite, NaN and flushed (a subnormal word, or a result that became zero by its size)
// of a binary number; least, negative, zero, positive and greatest of a fixed-point one.
struct ValueCoverage {
  NodeId node;
  std::vector<std::pair<std::string_view, long>> kinds;
};
// Of every input and operation of the design. O(samples * nodes).
std::vector<ValueCoverage> graph_coverage(const LoweredDesign& design, const BenchSamples& samples);

struct MutantResult {
  std::string what;
  std::int64_t sample;  // the first one whose results differ from the function's; -1 if none
};
// For each of graph_mutants. O(mutants * samples * nodes) at worst.
std::vector<MutantResult> run_graph_mutants(const LoweredDesign& design, const FunctionModel& model,
                                            const BenchSamples& samples);

// Print these for the samples of a run. The exit code: 0, or 1 if the graph is not the function, or
// no mutant was noticed. Mutants that no sample shows are listed: those that compute the same
// function, and those that need other samples.
int print_coverage(std::string_view name, const LoweredDesign& design, const FunctionModel& model,
                   const BenchSamples& samples);
int print_mutants(std::string_view name, const LoweredDesign& design, const FunctionModel& model,
                  const BenchSamples& samples);

}  // namespace emax
