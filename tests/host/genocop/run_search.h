#pragma once

#include <functional>
#include <optional>
#include <stdexcept>

#include "benchmark_problems.h"
#include "host/genocop/genocop.h"
#include "host/genocop/look_ahead_scheduler.h"

namespace emax::testing_help {

// After every evaluation.
using Observer = std::function<void(const Genocop&, const Candidate&, const Evaluation&)>;

// A whole search, one evaluation after the other.
inline std::optional<Best> run_search(const benchmark::BenchmarkProblem& bench,
                                      const Settings& settings, std::uint64_t seed,
                                      const Observer& observe = {}) {
  Genocop search(bench.problem, settings, seed);
  LookAheadScheduler scheduler(search, settings.budget);
  while (const auto candidate = scheduler.next()) {
    const Evaluation evaluation = bench.evaluate(candidate->genes);
    scheduler.complete(candidate->index, evaluation);
    if (observe) observe(search, *candidate, evaluation);
  }
  if (!scheduler.finished()) throw std::logic_error("the search stopped before its budget");
  return search.best();
}

}  // namespace emax::testing_help
