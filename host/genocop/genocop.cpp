#include "host/genocop/genocop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "host/genocop/ranking.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

const Settings& checked(const Settings& settings) {
  const auto check_number = [](const SettingInfo& info, double value) {
    if (value >= info.least && value <= info.greatest) return;
    throw Error(fmt::format("search setting {} is {}: it must be {} to {}", info.name, value,
                            info.least, info.greatest));
  };
  for (const SettingInfo& info : setting_infos()) {
    if (const auto* count = std::get_if<std::size_t Settings::*>(&info.member)) {
      check_number(info, static_cast<double>(settings.*(*count)));
    } else if (const auto* number = std::get_if<double Settings::*>(&info.member)) {
      check_number(info, settings.*(*number));
    }
  }
  double sum = 0;
  for (double frequency : settings.operator_frequencies) {
    if (!(frequency >= 0)) throw Error("operator frequencies must be at least 0");
    sum += frequency;
  }
  if (!(sum > 0) || !std::isfinite(sum)) {
    throw Error("operator frequencies: give at least one operator a frequency above 0");
  }
  return settings;
}

// An evaluation without finite numbers counts as failed.
Evaluation checked(Evaluation evaluation) {
  if (!std::isfinite(evaluation.objective) || std::isnan(evaluation.violation)) {
    evaluation.evaluated_ok = false;
  }
  return evaluation;
}

bool fits(const Evaluation& evaluation, const Problem& problem) {
  return !evaluation.evaluated_ok || evaluation.constraints.size() == problem.nonlinear.size();
}

// The movable coordinates of continuous genes and, with `whole_ones`, of integer genes.
std::vector<std::size_t> coordinates(const LinearDomain& domain, bool whole_ones) {
  std::vector<std::size_t> chosen;
  for (std::size_t k : domain.movable()) {
    const Gene::Kind kind = domain.gene(k).kind;
    if (kind == Gene::Kind::kContinuous || (whole_ones && kind == Gene::Kind::kInteger)) {
      chosen.push_back(k);
    }
  }
  return chosen;
}

}  // namespace

Genocop::Genocop(Problem problem, Settings settings, std::uint64_t seed)
    : settings_(checked(settings)),
      seed_(seed),
      problem_(std::move(problem)),
      domain_(problem_),
      frequencies_(settings_.operator_frequencies,
                   settings_.adaptive_frequencies ? settings_.frequency_floor : 0) {
  if (problem_.monotone_gene && settings_.monotone_step) {
    const std::size_t k = domain_.coordinate(*problem_.monotone_gene);
    if (k < domain_.size()) monotone_.emplace(domain_, k, settings_);  // else an equality holds it
  }
  if (auto ordered = coordinates(domain_, true); settings_.linear_model && !ordered.empty()) {
    linear_.emplace(domain_, problem_, std::move(ordered));
  }
  if (auto continuous = coordinates(domain_, false);
      settings_.finish && !monotone_ && !problem_.stepped && !continuous.empty()) {
    finish_.emplace(domain_, problem_, std::move(continuous));
    if (settings_.differential) differential_.emplace(domain_);
  }
  take_known();
  make_starts();
}

// Known results enter in their order, as if they were told.
void Genocop::take_known() {
  for (std::size_t i = 0; i < problem_.known.size(); ++i) {
    const Genes& genes = problem_.known[i].first;
    const Evaluation evaluation = checked(problem_.known[i].second);
    const Genes free = genes.size() == problem_.genes.size() ? domain_.reduce(genes) : Genes{};
    if (free.size() != domain_.size() || !domain_.contains(free)) {
      throw Error(fmt::format(
          "known result {}: outside a domain or a linear constraint; leave it out", i + 1));
    }
    if (!fits(evaluation, problem_)) {
      throw Error(
          fmt::format("known result {}: {} constraint values, the problem has {}; leave it out",
                      i + 1, evaluation.constraints.size(), problem_.nonlinear.size()));
    }
    if (!known_.try_emplace(cache_key(free), evaluation).second) continue;
    learn(free, evaluation);
    if (!evaluation.evaluated_ok) continue;
    offer_best(kKnownBefore, free, evaluation);
    const Individual individual{kKnownBefore - i, free, evaluation, {}};
    RandomStream random(seed_, i, RandomStream::Purpose::kKnown);
    if (evaluation.feasible()) enter_references(individual, std::nullopt);
    enter_search(individual, random);
    sort_populations();
  }
}

void Genocop::learn(const Genes& free, const Evaluation& evaluation) {
  if (monotone_) monotone_->told(free, evaluation);
  if (linear_) linear_->told(free, evaluation);
  if (finish_) finish_->told(free, evaluation);
}

bool Genocop::offer_best(std::uint64_t index, const Genes& free, const Evaluation& evaluation) {
  if (best_) {
    const Evaluation& old = best_->evaluation;
    if (evaluation.feasible() != old.feasible()) {
      if (old.feasible()) return false;
    } else if (evaluation.feasible() ? evaluation.objective >= old.objective
                                     : evaluation.violation >= old.violation) {
      return false;
    }
  }
  best_ = Best{index, domain_.complete(free), evaluation};
  return true;
}

void Genocop::note_gain(const Evaluation& evaluation) {
  constexpr double kGain = 1e-6;  // of the value; less is the end of a convergence
  if (descent_.best) {
    const Evaluation& old = *descent_.best;
    if (evaluation.feasible() != old.feasible()) {
      if (old.feasible()) return;
    } else if (evaluation.feasible()
                   ? !(evaluation.objective < old.objective - kGain * std::abs(old.objective))
                   : !(evaluation.violation < (1 - kGain) * old.violation)) {
      return;
    }
  }
  descent_.best = evaluation;
  descent_.gained = told_;
}

void Genocop::tell(std::uint64_t index, Evaluation evaluation) {
  if (index != told_ || index >= asked()) {
    throw std::logic_error(fmt::format("result {} told where {} is next", index, told_));
  }
  evaluation = checked(std::move(evaluation));
  if (!fits(evaluation, problem_)) {
    throw std::logic_error(fmt::format("result {} has {} constraint values, the problem {}", index,
                                       evaluation.constraints.size(), problem_.nonlinear.size()));
  }
  ++told_;
  Record& record = records_[index];
  record.evaluation = evaluation;
  if (record.role == Role::kDifferential) {  // no result of the descent
    ++descent_.gained;
    ++descent_.after_starts;
  }
  if (record.repeated) return;
  learn(record.free, evaluation);
  const Individual individual{index, record.free, evaluation, {}};
  const bool is_best = evaluation.evaluated_ok && offer_best(index, record.free, evaluation);
  if (record.role == Role::kLinear) linear_->judge(is_best);
  if (record.role == Role::kDifferential) {
    differential_->told(record.member, record.free, evaluation);
    return;
  }
  if (index < descent_.first) return;  // its populations are gone
  if (evaluation.evaluated_ok) note_gain(evaluation);

  RandomStream random(seed_, index, RandomStream::Purpose::kTell);
  if (record.chain) {
    RepairChain chain = std::move(*record.chain);
    record.chain.reset();
    chain.tell(evaluation);
    finish_repair(std::move(chain), individual, random);
  } else if (evaluation.evaluated_ok && record.role == Role::kFinish) {
    enter_finished(individual);
  } else if (evaluation.evaluated_ok) {
    std::optional<std::size_t> bred_by;
    if (record.bred) bred_by = record.bred->entry;
    bool in_repair = false;
    // Separate populations keep their own offspring once there are enough references.
    const bool apart = record.bred && !settings_.share_feasible &&
                       references_.size() >= settings_.reference_population;
    const bool of_references = record.bred && record.bred->from_references;
    if (evaluation.feasible()) {
      if (!apart || of_references) enter_references(individual, std::nullopt);
    } else if (record.role == Role::kSearch || record.role == Role::kLinear) {
      in_repair = start_repair(individual, bred_by, random);
    }
    if (record.bred && !in_repair)
      reward(record.bred->entry, key(individual) < record.bred->parent);
    if (!apart || !of_references) enter_search(individual, random);
  } else if (record.bred) {
    reward(record.bred->entry, false);
  }
  sort_populations();
}

void Genocop::reward(std::size_t entry, bool success) {
  if (settings_.adaptive_frequencies) frequencies_.reward(entry, success ? 1 : 0);
}

// Sort key; a smaller key is better. If the monotone gene gives the price of violation, every point
// counts with the objective that it would have on the constraint, moved along its line. Otherwise
// feasible and repaired points come first.
Genocop::SortKey Genocop::key(const Individual& individual) const {
  const Evaluation& e = individual.evaluation;
  const double price = monotone_ ? monotone_->price() : 0;
  std::optional<double> value = individual.repaired_objective;
  if (price > 0) {
    const double moved = e.objective + price * e.violation;
    value = std::min(value.value_or(moved), moved);
  } else if (e.feasible()) {
    value = e.objective;
  }
  return value ? SortKey{0, *value} : SortKey{1, e.violation};
}

void Genocop::sort_populations() {
  std::vector<std::pair<SortKey, std::size_t>> order;
  for (std::size_t i = 0; i < search_.size(); ++i) order.emplace_back(key(search_[i]), i);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Individual> sorted;
  sorted.reserve(order.size());
  for (const auto& [sort_key, i] : order) sorted.push_back(std::move(search_[i]));
  search_ = std::move(sorted);
  std::stable_sort(references_.begin(), references_.end(),
                   [](const Individual& a, const Individual& b) {
                     return a.evaluation.objective < b.evaluation.objective;
                   });
}

void Genocop::enter_search(Individual individual, RandomStream& random) {
  // The population holds one point of each line; more would only narrow it.
  for (Individual& member : search_) {
    if (!monotone_ || !monotone_->same_line(member.free, individual.free)) continue;
    if (key(individual) < key(member)) member = std::move(individual);
    return;
  }
  if (search_.size() < settings_.search_population) {
    search_.push_back(std::move(individual));
    return;
  }
  const std::vector<double> probabilities =
      ranking_probabilities(search_.size(), settings_.selection_pressure);
  const std::size_t rank = search_.size() - 1 - select(probabilities, random);
  const bool may_go = rank > 0 && !settings_.replace_worse_only;
  if (Individual& victim = search_[rank]; may_go || key(individual) < key(victim)) {
    victim = std::move(individual);
  }
}

// A repaired point competes with the reference it was repaired towards; any other point competes
// with the worst reference. A repaired point that loses also competes with the worst if feasible
// points are shared.
void Genocop::enter_references(Individual individual, std::optional<std::uint64_t> replaced) {
  const auto better = [&](const Individual& member) {
    return individual.evaluation.objective < member.evaluation.objective;
  };
  for (Individual& member : references_) {
    const bool same_line = monotone_ && monotone_->same_line(member.free, individual.free);
    if (!same_line && member.id != replaced) continue;
    if (better(member)) {
      member = std::move(individual);
      return;
    }
    if (same_line) return;
  }
  if (replaced && !settings_.share_feasible) return;
  if (references_.size() < settings_.reference_population) {
    references_.push_back(std::move(individual));
  } else if (better(references_.back())) {
    references_.back() = std::move(individual);
  }
}

// A local search keeps at most one reference, because its points would fill the population.
void Genocop::enter_finished(Individual individual) {
  if (!individual.evaluation.feasible()) return;
  for (Individual& member : references_) {
    if (member.id != finish_reference_) continue;
    if (individual.evaluation.objective >= member.evaluation.objective) return;
    finish_reference_ = individual.id;
    member = std::move(individual);
    return;
  }
  finish_reference_ = individual.id;
  enter_references(std::move(individual), std::nullopt);
}

bool Genocop::start_repair(const Individual& individual, std::optional<std::size_t> bred_by,
                           RandomStream& random) {
  if (references_.empty() || settings_.max_repair_tries == 0) return false;
  // If the price of violation is known, the climb repairs along the monotone gene, and repairs only
  // points that can then beat the incumbent.
  if (monotone_ && monotone_->price() > 0) return false;
  const std::vector<double> probabilities =
      ranking_probabilities(references_.size(), settings_.selection_pressure);
  const Individual& reference = references_[select(probabilities, random)];
  const bool promising = individual.evaluation.objective < reference.evaluation.objective;
  if (settings_.repair_only_promising && !promising) return false;
  RepairChain chain(settings_.repair, individual.free, individual.evaluation.violation,
                    reference.free, reference.evaluation.violation);
  chain.search_id = individual.id;
  chain.reference_id = reference.id;
  chain.reference_objective = reference.evaluation.objective;
  chain.bred_by = bred_by;
  repairs_.push_back(std::move(chain));
  return true;
}

void Genocop::finish_repair(RepairChain chain, const Individual& point, RandomStream& random) {
  const bool feasible = point.evaluation.feasible();
  if (!feasible && chain.tries() < settings_.max_repair_tries) {
    repairs_.push_back(std::move(chain));
    return;
  }
  end_repair(chain, point.evaluation);
  if (!feasible) return;
  enter_references(point, chain.reference_id);
  if (!random.chance(settings_.replacement_probability)) return;
  for (Individual& member : search_) {
    if (member.id == chain.search_id) member = point;
  }
}

// Ends a repair with its last result, which may have been known before.
void Genocop::end_repair(const RepairChain& chain, const Evaluation& result) {
  const bool gained = result.feasible() && result.objective < chain.reference_objective;
  if (chain.bred_by) reward(*chain.bred_by, gained);
  if (!result.feasible()) return;
  for (Individual& member : search_) {
    if (member.id == chain.search_id) member.repaired_objective = result.objective;
  }
}

}  // namespace emax
