#include "testbench/lowered/function_bench.h"

#include <cstdio>

#include "testbench/lowered/bench_samples.h"
#include "testbench/lowered/graph_checks.h"

namespace emax {
namespace {

bool is_equal_every_cycle(const FunctionBench& bench, const BenchOptions& options) {
  const auto samples = drawn_samples(bench.name, bench.model, options);
  for (int cycle = 0; cycle < options.samples + bench.latency; ++cycle) {
    for (std::size_t i = 0; i < bench.inputs.size(); ++i) {
      const int given = cycle - (bench.cycles.empty() ? 0 : bench.cycles[i]);
      if (given >= 0 && given < options.samples) {
        bench.inputs[i].set(samples[static_cast<std::size_t>(given)][i]);
      }
    }
    bench.evaluate(false);
    const int sample = cycle - bench.latency - options.late;
    const auto number = static_cast<std::size_t>(sample);
    if (sample >= 0 && sample < options.samples &&
        !is_models_result(bench.name, bench.model, bench.outputs, samples[number], number,
                          options.seed)) {
      return false;
    }
    bench.evaluate(true);
  }
  return true;
}

}  // namespace

int run_bench(const FunctionBench& bench, int argc, char** argv) {
  return bench_exit_code(bench.name, argc, argv, [&](const BenchOptions& options) {
    if (options.check != BenchCheck::kResults) {
      const auto print = options.check == BenchCheck::kMutants ? print_mutants : print_coverage;
      return print(bench.name, bench.lowered(), bench.model,
                   drawn_samples(bench.name, bench.model, options));
    }
    if (!is_equal_every_cycle(bench, options)) return 1;
    std::printf("%.*s: %d samples of seed %llu, a result every cycle after %d cycles, all equal\n",
                static_cast<int>(bench.name.size()), bench.name.data(), options.samples,
                static_cast<unsigned long long>(options.seed), bench.latency);
    return 0;
  });
}

}  // namespace emax
