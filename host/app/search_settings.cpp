#include "host/app/search_settings.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <numeric>

#include "host/app/interrupt.h"
#include "host/parameters/descriptions.h"
#include "host/parameters/registry.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

SearchSpace space_of(const OptimizeOptions& options) {
  if (!keeps_bound(options.decimator)) return SearchSpace::kDecimations;
  return method_for(options.method, options.decimator) == kFitMethod ? SearchSpace::kOneReference
                                                                     : SearchSpace::kSurfaces;
}

std::uint64_t budget_of(const OptimizeOptions& options, std::uint64_t configured,
                        std::size_t points) {
  if (options.budget) return *options.budget;
  const SearchEffort effort = options.effort == "quick"  ? SearchEffort::kQuick
                              : options.effort == "deep" ? SearchEffort::kDeep
                                                         : SearchEffort::kNormal;
  const std::uint64_t budget =
      search_budget(effort, points, space_of(options),
                    options.config.empty() ? std::nullopt : std::optional(configured));
  // One candidate on planes and one without them is the least that anything is decided from.
  return options.features == kAutoFeatures ? std::max<std::uint64_t>(budget, 2) : budget;
}

EvaluationLimits evaluation_limits(const OptimizeOptions& options, std::size_t points) {
  EvaluationLimits limits = standard_limits(points);
  if (options.evaluation_seconds) {
    limits.time = std::chrono::ceil<std::chrono::milliseconds>(
        std::chrono::duration<double>(*options.evaluation_seconds));
  }
  if (options.evaluation_memory) limits.memory = *options.evaluation_memory;
  return limits;
}

// With at most so many for each process.
unsigned all_jobs(const Machines& machines, unsigned most) {
  return std::transform_reduce(machines.processors.begin(), machines.processors.end(), 0u,
                               std::plus(),
                               [most](unsigned processors) { return std::min(processors, most); });
}

}  // namespace

bool is_two_sided(const OptimizeOptions& options) {
  const bool bounded = keeps_bound(options.decimator);
  const bool two_sided = options.bound.empty() ? bounded : options.bound == "two-sided";
  if (two_sided && !bounded) {
    throw Error("--bound two-sided needs --decimator " + alternatives(names_of_decimators(true)) +
                "; the paper's chain bounds the points");
  }
  return two_sided;
}

OptimizeSettings search_settings(const OptimizeOptions& options) {
  OptimizeSettings settings;
  settings.method = method_for(options.method, options.decimator);
  if (settings.method == kFitMethod && options.method != kFitMethod) {
    settings.reference_method = options.method;
  }
  settings.decimator = options.decimator;
  if (options.features != kNoFeatures && !keeps_bound(options.decimator)) {
    throw Error("--features needs --decimator " + alternatives(names_of_decimators(true)) +
                "; the paper's decimation follows no planes");
  }
  settings.features = options.features;
  const auto parameters = chain_parameters(settings.method, options.decimator, options.features);
  settings.config =
      options.config.empty() ? default_config(parameters) : read_config(options.config, parameters);
  settings.seed = options.seed;
  const auto processes = static_cast<unsigned>(options.machines.processors.size());
  constexpr unsigned kAny = std::numeric_limits<unsigned>::max();
  const unsigned jobs =
      options.jobs > 0 ? options.jobs * processes : all_jobs(options.machines, kAny);
  // At most this many candidates are out at a time.
  settings.jobs =
      static_cast<unsigned>(std::min<std::size_t>(jobs, settings.config.search.look_ahead));
  settings.target_triangles = options.target_triangles;
  settings.stagnation = options.stagnation;
  settings.polish = options.polish;
  settings.output = options.output;
  settings.interrupted = was_interrupted;
  settings.closed = options.closed;
  settings.make_pool = options.machines.make_pool;
  return settings;
}

bool is_one_deep(const OptimizeOptions& options, std::size_t points) {
  return options.effort == "normal" && !options.budget && options.config.empty() &&
         options.polish && space_of(options) == SearchSpace::kOneReference &&
         decimates_deep_at_once(points);
}

void suit_to_cloud(OptimizeSettings& settings, const OptimizeOptions& options, std::size_t points) {
  std::size_t& budget = settings.config.search.budget;
  budget = budget_of(options, budget, points);
  settings.limits = evaluation_limits(options, points);
  if (options.jobs == 0) {
    const unsigned in_memory =
        std::max(1u, jobs_in_memory(*settings.limits) / options.machines.processes_on_one);
    settings.jobs = std::min(settings.jobs, all_jobs(options.machines, in_memory));
  }
  if (is_one_deep(options, points)) {
    for (Parameter& gene : settings.config.genes) {
      if (gene.name == Bounded::kEffort.name) gene.fixed = Bounded::kDeepEffort;
    }
    if (!options.evaluation_seconds) settings.limits->time *= kDeepTimeLimit;
  }
}

double expected_search_seconds(const OptimizeSettings& settings, const OptimizeOptions& options,
                               std::size_t points, std::size_t logged) {
  const std::size_t budget = settings.config.search.budget;
  if (is_one_deep(options, points)) {
    return expected_seconds(SearchSpace::kOneReference, points, 0,
                            budget - std::min(budget, logged), settings.jobs);
  }
  const bool polishes = settings.polish && takes_bound(settings.decimator);
  return expected_seconds(space_of(options), points, budget - std::min(budget, logged),
                          polishes ? std::min(budget, polished_candidates(points)) : 0,
                          settings.jobs);
}

}  // namespace emax
