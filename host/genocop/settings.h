#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "host/genocop/operators.h"

namespace emax {

enum class RepairMethod {
  kRandom,         // z = a s + (1-a) r, a uniform
  kDeterministic,  // a = 1/2, 1/4, ...
  kValueAware      // regula falsi on the violation along the segment
};

// All settings that the search depends on besides problem and seed. The strategies that are not in
// Genocop III are monotone_step, linear_model, finish, restart_after, differential,
// adaptive_frequencies, sobol_starts, first_phase, cache, replace_worse_only with share_feasible,
// repair_only_promising, the value-aware repair and the uniform mutation (from Genocop). Each has
// its own setting.
struct Settings {
  std::size_t budget = 150;  // T of the operators whose steps shrink
  // The budgets that the search had before this one, ascending. T of candidate i is the first of
  // all budgets that is greater than i. A search that continues with a larger budget therefore asks
  // for the same candidates as before, up to the end of the smaller budget.
  std::vector<std::size_t> earlier_budgets = {};
  std::size_t look_ahead = 16;  // K: candidate i depends on the results up to i - K

  std::size_t search_population = 8;
  std::size_t reference_population = 8;
  double selection_pressure = 0.1;  // q of the ranking selection, in (0, 1)
  double reference_share = 0.5;     // share of the offspring whose parents are reference points
  bool replace_worse_only = true;   // offspring replace a search point only if better
  bool share_feasible = true;       // feasible points of any origin become references

  RepairMethod repair = RepairMethod::kValueAware;
  std::size_t max_repair_tries = 3;   // evaluations for one search point; 0: no repair
  bool repair_only_promising = true;  // only points whose objective beats that of their reference
  double replacement_probability = 0.25;  // p_r: that a repaired point replaces its search point

  std::size_t non_uniform_power = 2;  // b of the non-uniform mutations
  double gaussian_sigma = 0.1;  // standard deviation at the start, in feasible ranges of the gene
  std::array<double, kOperators.size()> operator_frequencies = standard_frequencies();

  // A gene along which the objective falls and the violation rises is not a gene of the search;
  // every evaluation searches its best value. This setting is for the code that evaluates; the
  // search itself does not use it.
  bool monotone_walk = true;
  bool monotone_step = true;           // if the problem names a monotone gene
  double monotone_share = 0.97;        // of the offspring: aim just below the incumbent
  double monotone_gain = 0.02;         // how far below, of its objective; less after 150 candidates
  std::size_t monotone_in_flight = 3;  // trials of one line at a time
  std::size_t monotone_fan = 6;        // values of the gene tried on the first start point

  bool linear_model = true;          // steps of local linear models around the best point
  double linear_share = 0.2;         // of the candidates that other strategies leave
  bool finish = true;                // local searches on the continuous genes
  double finish_share = 0.6;         // of the candidates while one runs; more with many genes
  double finish_radius = 0.1;        // the first trust region, of the domains
  std::size_t restart_after = 300;   // evaluations without gain, where local searches run; 0: never
  bool differential = true;          // evolution beside the descents, with many genes
  bool first_phase = true;           // while nothing is feasible, minimise the violation
  bool adaptive_frequencies = true;  // of the operators
  double frequency_floor = 0.3;      // of the offspring, divided equally among the operators
  bool sobol_starts = true;          // false: a Latin hypercube
  bool cache = true;                 // points that were evaluated are not evaluated again
  double cache_resolution = 1e-13;   // of the domains: genes are rounded to it and compared

  // The entry of operator_frequencies for an operator of kOperators.
  double& frequency_of(Operator apply);

  bool operator==(const Settings&) const = default;

  // Genocop III as published (Michalewicz & Nazhiyath 1995; Michalewicz 1996): populations of 70,
  // p_r = 0.15, its ten operators, offspring that replace whatever their value, populations that
  // exchange points only by repairs, random repair until feasible (at most 100 trials), one result
  // after the other. Its sources leave q and b open or give different values; q = 0.02 and b = 6
  // reach its published results. The first phase replaces the user, whom Genocop III asks for a
  // first feasible point.
  static Settings original();

  static constexpr std::array<double, kOperators.size()> standard_frequencies() {
    std::array<double, kOperators.size()> frequencies{};
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      frequencies[i] = kOperators[i].standard_frequency;
    }
    return frequencies;
  }
};

// A setting by name, with its meaning and its permitted values, for configuration files and for
// Genocop's check.
struct SettingInfo {
  using Member = std::variant<std::size_t Settings::*, double Settings::*, bool Settings::*,
                              RepairMethod Settings::*>;

  std::string_view name;
  Member member;
  double least;  // both ends included; only for numbers
  double greatest;
  std::string_view meaning;
};

std::span<const SettingInfo> setting_infos();
inline constexpr std::array<std::string_view, 3> kRepairMethods = {"random", "deterministic",
                                                                   "value-aware"};

}  // namespace emax
