#include "host/genocop/settings.h"

#include <algorithm>

namespace emax {

std::span<const SettingInfo> setting_infos() {
  using S = Settings;
  static const std::array<SettingInfo, 33> infos = {{
      {"budget", &S::budget, 1, 1e9, "evaluations, including every trial"},
      {"look_ahead", &S::look_ahead, 1, 1e6,
       "candidate i depends on the results up to i - look_ahead; at least the number of workers; "
       "smaller is better; results depend on it"},
      {"search_population", &S::search_population, 1, 1e6,
       "points inside domains and linear constraints"},
      {"reference_population", &S::reference_population, 1, 1e6, "feasible points"},
      {"selection_pressure", &S::selection_pressure, 1e-6, 0.999,
       "q: share of the selections that goes to the best of a large population"},
      {"reference_share", &S::reference_share, 0, 1,
       "share of the offspring whose parents are reference points"},
      {"replace_worse_only", &S::replace_worse_only, 0, 0,
       "offspring replace a search point only if they are better; false: always, except the best"},
      {"share_feasible", &S::share_feasible, 0, 0,
       "feasible offspring of search points become references, and so do repaired points that do "
       "not beat their own reference; false: only the offspring, while references are too few"},
      {"repair", &S::repair, 0, 0,
       "trials between an infeasible point and a reference: \"random\", \"deterministic\" (1/2, "
       "1/4, ...) or \"value-aware\" (regula falsi on the violation)"},
      {"max_repair_tries", &S::max_repair_tries, 0, 1e6, "evaluations for one point; 0: no repair"},
      {"repair_only_promising", &S::repair_only_promising, 0, 0,
       "repair only points whose objective beats that of their reference"},
      {"replacement_probability", &S::replacement_probability, 0, 1,
       "p_r: probability that a repaired point replaces its search point"},
      {"non_uniform_power", &S::non_uniform_power, 0, 100,
       "b: how fast the steps of the non-uniform mutations shrink"},
      {"gaussian_sigma", &S::gaussian_sigma, 0, 1e3,
       "standard deviation of the Gaussian mutation at the start, in feasible ranges of the gene"},
      {"monotone_walk", &S::monotone_walk, 0, 0,
       "a gene along which the objective falls and the violation rises, and which is in no linear "
       "constraint, is searched within every evaluation and is no gene of the search"},
      {"monotone_step", &S::monotone_step, 0, 0,
       "use a gene along which the objective falls and the violation rises, if there is one"},
      {"monotone_share", &S::monotone_share, 0, 1,
       "share of the offspring that aim just below the best objective"},
      {"monotone_gain", &S::monotone_gain, 0, 1,
       "how far below, as a share of the best objective; decreases after 150 candidates"},
      {"monotone_in_flight", &S::monotone_in_flight, 1, 1e6,
       "trials at one time of points that differ only in the monotone gene"},
      {"monotone_fan", &S::monotone_fan, 0, 1e6,
       "values of the monotone gene tried on the start point"},
      {"linear_model", &S::linear_model, 0, 0,
       "steps of local linear models of objective and constraints around the best point"},
      {"linear_share", &S::linear_share, 0, 1,
       "share of these steps among the candidates that other strategies leave"},
      {"finish", &S::finish, 0, 0, "local searches on the continuous genes from the best points"},
      {"finish_share", &S::finish_share, 0, 1,
       "share of local searches among the candidates while one runs; greater with more than eight "
       "genes where the local models predict well"},
      {"finish_radius", &S::finish_radius, 1e-6, 0.5,
       "first trust region of a local search, as a share of the genes' domains"},
      {"restart_after", &S::restart_after, 0, 1e9,
       "evaluations without gain after which populations and local searches begin anew; 0: never; "
       "only where local searches run"},
      {"differential", &S::differential, 0, 0,
       "differential evolution once a local search has ended, with more than eight genes; "
       "only where local searches run"},
      {"first_phase", &S::first_phase, 0, 0,
       "minimise the violation while nothing is feasible; false: draw at random"},
      {"adaptive_frequencies", &S::adaptive_frequencies, 0, 0,
       "operators whose offspring succeed become more frequent"},
      {"frequency_floor", &S::frequency_floor, 0, 1,
       "share of the offspring that is divided equally among the operators"},
      {"sobol_starts", &S::sobol_starts, 0, 0,
       "first points from Sobol's sequence; false: a Latin hypercube"},
      {"cache", &S::cache, 0, 0, "points that were evaluated are not evaluated again"},
      {"cache_resolution", &S::cache_resolution, 0, 0.5,
       "genes that round to the same multiple of this share of their domain count as equal"},
  }};
  return infos;
}

double& Settings::frequency_of(Operator apply) {
  const auto found = std::ranges::find(kOperators, apply, &OperatorEntry::apply);
  return operator_frequencies.at(static_cast<std::size_t>(found - kOperators.begin()));
}

Settings Settings::original() {
  Settings settings;
  settings.look_ahead = 1;
  settings.search_population = settings.reference_population = 70;
  settings.selection_pressure = 0.02;
  settings.non_uniform_power = 6;
  settings.replace_worse_only = settings.share_feasible = false;
  settings.replacement_probability = 0.15;
  settings.repair = RepairMethod::kRandom;
  settings.max_repair_tries = 100;
  settings.repair_only_promising = false;
  settings.frequency_of(uniform_mutation) = 0;
  settings.monotone_step = settings.linear_model = settings.finish = settings.differential = false;
  settings.restart_after = 0;
  settings.adaptive_frequencies = settings.sobol_starts = false;
  settings.cache = false;
  return settings;
}

}  // namespace emax
