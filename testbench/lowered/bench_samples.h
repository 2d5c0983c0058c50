// What the benches of lowered functions share: their command line, samples, and how a difference is
// told.
#pragma once

#include <cstdint>
#include <functional>
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

// The exit code of a bench: that of `run` with the options of its command line, or 2, with the
// reason on standard error, for arguments that are not understood.
int bench_exit_code(std::string_view name, int argc, char** argv,
                    const std::function<int(const BenchOptions&)>& run);

// The same for a bench that compares results and nothing else. `compare` returns what the results
// are that were all equal, for its last line, or nothing after the first difference.
int comparison_exit_code(
    std::string_view name, int argc, char** argv,
    const std::function<std::optional<std::string>(const BenchOptions&)>& compare);

// Bits for every argument of the model, `options.samples` times.
std::vector<std::vector<Bits>> drawn_samples(std::string_view name, const FunctionModel& model,
                                             const BenchOptions& options);

// Compares the outputs with the model's results for a sample, and prints the first difference.
bool is_models_result(std::string_view name, const FunctionModel& model,
                      const std::vector<BenchPort>& outputs, const std::vector<Bits>& sample,
                      std::size_t number, std::uint64_t seed);

}  // namespace emax
