// What the benches of lowered functions share: their command line, samples, and how a difference is
// told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/lowered/function_bench.h"

namespace emax {

enum class BenchCheck : std::uint8_t { kResults, kCoverage, kMutants };

struct BenchOptions {
  int samples = 20000;
  std::uint64_t seed = 1;
  int late = 0;  // how many results the comparison is behind
  BenchCheck check = BenchCheck::kResults;
};

// Throws std::invalid_argument for arguments that are not understood.
BenchOptions bench_options(int argc, char** argv);

// Bits for every argument of the model, `options.samples` times.
std::vector<std::vector<Bits>> drawn_samples(std::string_view name, const FunctionModel& model,
                                             const BenchOptions& options);

// Compares the outputs with the model's results for a sample, and prints the first difference.
bool is_models_result(std::string_view name, const FunctionModel& model,
                      const std::vector<BenchPort>& outputs, const std::vector<Bits>& sample,
                      std::size_t number, std::uint64_t seed);

}  // namespace emax
