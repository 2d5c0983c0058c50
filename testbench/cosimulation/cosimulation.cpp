#include "testbench/cosimulation/cosimulation.h"

#include <algorithm>
#include <chrono>

namespace emax {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Mismatch wrong_interval(const RunResult& result) {
  return {"s_axis_point",
          result.pairs,
          {},
          result.cycles,
          "initiation interval: " + std::to_string(result.pairs) + " pairs were accepted in " +
              std::to_string(result.accepting_cycles) + " cycles, one a cycle is promised"};
}

}  // namespace

TestReport run_test(const ElementTest& test, const ElementFactory& make_element,
                    const CosimulationOptions& options) {
  TestReport report;
  report.name = test.name;
  report.seed = named_seed(test.name, options.seed);
  const auto start = Clock::now();
  const auto element = make_element(test.slot_bits);
  element->set_mutant(options.mutant);
  const std::uint64_t all = options.full ? test.full_runs : test.quick_runs;
  const std::uint64_t count = std::max(all / options.part, std::min<std::uint64_t>(all, 2));
  std::uint64_t free_pairs = 0, free_cycles = 0;
  for (std::uint64_t i = 0; i < count && !report.failure; ++i) {
    if (options.stop != nullptr && *options.stop) {
      report.stopped = true;
      break;
    }
    if (options.progress) options.progress(static_cast<double>(i) / static_cast<double>(count));
    Random random(report.seed + i);
    const std::vector<ElementRun> runs = test.make(i, random);
    for (std::size_t r = 0; r < runs.size() && !report.failure; ++r) {
      const Expected expected = expected_of(runs[r]);
      const auto driven = Clock::now();
      RunResult result = drive(*element, runs[r], expected);
      report.simulating_seconds += seconds_since(driven);
      report.pairs += result.pairs;
      report.blocks += result.worst;
      report.minima += result.nearest;
      report.cycles += result.cycles;
      if (test.ii_is_one && runs[r].patterns.all_willing() && !result.mismatch) {
        free_pairs += result.pairs;
        free_cycles += result.accepting_cycles;
        if (result.pairs != result.accepting_cycles) result.mismatch = wrong_interval(result);
      }
      if (result.mismatch) {
        const auto first = runs.begin();
        report.mismatches = 1;
        report.failure = Failure{test.name,
                                 report.seed,
                                 test.slot_bits,
                                 options.mutant,
                                 {first, first + static_cast<std::ptrdiff_t>(r) + 1},
                                 *result.mismatch};
      }
    }
  }
  if (free_pairs > 0) {
    report.initiation_interval = static_cast<double>(free_cycles) / static_cast<double>(free_pairs);
  }
  report.seconds = seconds_since(start);
  return report;
}

RunResult run_sequence(const std::vector<ElementRun>& runs, ElementSimulation& element,
                       RunObserver* observer) {
  RunResult result;
  for (const ElementRun& run : runs) {
    result = drive(element, run, expected_of(run), &run == &runs.back() ? observer : nullptr);
    if (result.mismatch) break;
  }
  return result;
}

}  // namespace emax
