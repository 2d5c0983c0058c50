#include "host/genocop/genocop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "host/genocop/ranking.h"
#include "sw_model/error.h"

namespace emax {
namespace {

constexpr int kRedraws = 20;  // of a duplicate: first as offspring, then anywhere in the domain

void check(const Settings& settings) {
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
}

}  // namespace

Genocop::Genocop(Problem problem, Settings settings, std::uint64_t seed)
    : settings_(settings), seed_(seed), problem_(std::move(problem)), domain_(problem_) {
  check(settings_);
  if (problem_.monotone_gene && settings_.monotone_step) {
    const std::size_t k = domain_.coordinate(*problem_.monotone_gene);
    monotone_.emplace(domain_, k, settings_);
  }
  make_starts();
}

// The given starts; the first one at evenly spaced values of the monotone gene; then a Latin
// hypercube, one point in each of as many slices of every gene.
void Genocop::make_starts() {
  for (const Genes& start : problem_.starts) starts_.push_back(domain_.reduce(start));
  if (monotone_ && !starts_.empty()) {
    const Genes first = starts_.front();
    const std::size_t k = domain_.coordinate(*problem_.monotone_gene);
    const Interval range = domain_.range(first, k);
    for (std::size_t i = 0; i < settings_.monotone_fan; ++i) {
      Genes point = first;
      point[k] = range.lower + (range.upper - range.lower) * static_cast<double>(i) /
                                   static_cast<double>(settings_.monotone_fan);
      starts_.push_back(domain_.pull_inside(point, first));
    }
  }
  const std::size_t wanted =
      std::max<std::size_t>(settings_.search_population, settings_.look_ahead);
  if (starts_.size() >= wanted) return;
  const std::size_t count = wanted - starts_.size();
  RandomStream random(seed_, 0, RandomStream::Purpose::kStart);
  std::vector<std::vector<double>> positions(count, std::vector<double>(domain_.size()));
  for (std::size_t k = 0; k < domain_.size(); ++k) {
    const std::vector<std::size_t> slices = random.permutation(count);
    for (std::size_t i = 0; i < count; ++i) {
      positions[i][k] =
          (static_cast<double>(slices[i]) + random.uniform()) / static_cast<double>(count);
    }
  }
  for (const auto& position : positions) {
    starts_.push_back(domain_.from_unit_cube(position, random));
  }
}

Candidate Genocop::ask() {
  const std::uint64_t index = asked();
  const std::uint64_t known = index < settings_.look_ahead ? 0 : index - settings_.look_ahead + 1;
  if (told_ != known) {
    throw std::logic_error(fmt::format("candidate {} depends on the first {} results, {} were told",
                                       index, known, told_));
  }
  RandomStream random(seed_, index, RandomStream::Purpose::kAsk);
  Proposal proposal = propose(random);
  const auto [entry, fresh] = first_.try_emplace(proposal.free, index);
  Candidate candidate{index, domain_.complete(proposal.free), proposal.origin, std::nullopt};
  if (!fresh) candidate.same_as = entry->second;
  if (monotone_) monotone_->asked(proposal.free);
  records_.push_back(
      {std::move(proposal.free), proposal.role, !fresh, std::move(proposal.chain), std::nullopt});
  return candidate;
}

Genocop::Proposal Genocop::propose(RandomStream& random) {
  if (asked() < starts_.size()) {
    if (const Genes& start = starts_[asked()]; is_new(start)) return {start, "start", {}, {}};
  } else {
    if (monotone_) {
      if (std::optional<Genes> trial = monotone_->climb(); trial && is_new(*trial)) {
        return {std::move(*trial), "climb", Role::kClimb, {}};
      }
    }
    if (std::optional<Proposal> repair = next_repair(random)) return std::move(*repair);
    for (int draw = 0; draw < kRedraws; ++draw) {
      std::optional<Proposal> child = offspring(random);
      if (!child) break;
      if (is_new(child->free)) return std::move(*child);
    }
  }
  Genes point = domain_.sample(random);
  for (int draw = 1; draw < kRedraws && !is_new(point); ++draw) point = domain_.sample(random);
  return {std::move(point), "sample", Role::kSearch, {}};
}

std::optional<Genocop::Proposal> Genocop::next_repair(RandomStream& random) {
  while (!repairs_.empty()) {
    RepairChain chain = std::move(repairs_.front());
    repairs_.pop_front();
    Genes point = chain.next(domain_, random);
    const auto known = first_.find(point);
    if (known == first_.end()) return Proposal{std::move(point), "repair", Role::kRepair, chain};
    // A known result serves without being charged; one still in flight ends the repair.
    const Record& record = records_[known->second];
    if (!record.evaluation) continue;
    chain.tell(*record.evaluation);
    if (!record.evaluation->feasible() && chain.tries() < settings_.max_repair_tries) {
      repairs_.push_front(std::move(chain));
    }
  }
  return std::nullopt;
}

std::optional<Genocop::Proposal> Genocop::offspring(RandomStream& random) {
  if (domain_.movable().empty()) return std::nullopt;
  const bool from_references =
      !references_.empty() && (search_.empty() || random.chance(settings_.reference_share));
  const std::vector<Individual>& population = from_references ? references_ : search_;
  if (population.empty()) return std::nullopt;

  const OperatorEntry& entry = kOperators[select(settings_.operator_frequencies, random)];
  const std::vector<double> probabilities =
      ranking_probabilities(population.size(), settings_.selection_pressure);
  std::vector<std::size_t> ranks(entry.parents);
  for (std::size_t& rank : ranks) rank = select(probabilities, random);
  std::sort(ranks.begin(), ranks.end());
  std::vector<Genes> parents;
  parents.reserve(ranks.size());
  for (std::size_t rank : ranks) parents.push_back(population[rank].free);

  const OperatorInput input{domain_, parents, remaining(), settings_.non_uniform_power,
                            settings_.gaussian_sigma};
  Genes child = entry.apply(input, random);
  if (monotone_ && random.chance(settings_.monotone_share)) {
    child = monotone_->aim(child, parents[0], population[ranks[0]].evaluation);
  }
  return Proposal{std::move(child), entry.name, Role::kSearch, {}};
}

double Genocop::remaining() const {
  const double spent = static_cast<double>(asked()) /
                       static_cast<double>(std::max<std::uint64_t>(settings_.budget, 1));
  return std::max(1 - spent, 0.0);
}

void Genocop::tell(std::uint64_t index, Evaluation evaluation) {
  if (index != told_ || index >= asked()) {
    throw std::logic_error(fmt::format("result {} told where {} is next", index, told_));
  }
  ++told_;
  if (!std::isfinite(evaluation.objective) || std::isnan(evaluation.violation)) {
    evaluation.evaluated_ok = false;
  }
  Record& record = records_[index];
  record.evaluation = evaluation;
  if (record.repeated) return;
  if (monotone_) monotone_->told(record.free, evaluation);

  const Individual individual{index, record.free, evaluation, {}};
  if (evaluation.evaluated_ok) {
    const bool first = !best_;
    const bool feasible_first = !first && evaluation.feasible() && !best_->evaluation.feasible();
    const bool same_kind = !first && evaluation.feasible() == best_->evaluation.feasible();
    const bool less =
        !first && (evaluation.feasible() ? evaluation.objective < best_->evaluation.objective
                                         : evaluation.violation < best_->evaluation.violation);
    if (first || feasible_first || (same_kind && less)) {
      best_ = Best{index, domain_.complete(record.free), evaluation};
    }
  }
  RandomStream random(seed_, index, RandomStream::Purpose::kTell);
  if (record.chain) {
    RepairChain chain = std::move(*record.chain);
    record.chain.reset();
    chain.tell(evaluation);
    finish_repair(std::move(chain), individual, random);
  } else if (evaluation.evaluated_ok) {
    if (evaluation.feasible()) {
      enter_references(individual, std::nullopt);
    } else if (record.role == Role::kSearch) {
      start_repair(individual, random);
    }
    enter_search(individual, random);
  }
  sort_populations();
}

// Better is less. Where the monotone gene tells the price of violation, every point counts as if
// moved along its line to the constraint; otherwise feasible and repaired points come first.
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
  // One point of a line stands for it; more would only narrow the population.
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
  Individual& victim = search_[search_.size() - 1 - select(probabilities, random)];
  if (key(individual) < key(victim)) victim = std::move(individual);
}

// A repaired point competes with the reference it was repaired towards, any other with the worst.
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
  if (references_.size() < settings_.reference_population) {
    references_.push_back(std::move(individual));
  } else if (better(references_.back())) {
    references_.back() = std::move(individual);
  }
}

void Genocop::start_repair(const Individual& individual, RandomStream& random) {
  if (references_.empty() || settings_.max_repair_tries == 0) return;
  // With the price of violation known, the climb repairs along the monotone gene, and only those
  // points that can then beat the incumbent.
  if (monotone_ && monotone_->price() > 0) return;
  const std::vector<double> probabilities =
      ranking_probabilities(references_.size(), settings_.selection_pressure);
  const Individual& reference = references_[select(probabilities, random)];
  const bool promising = individual.evaluation.objective < reference.evaluation.objective;
  if (settings_.repair_only_promising && !promising) return;
  RepairChain chain(settings_.repair, individual.free, individual.evaluation.violation,
                    reference.free, reference.evaluation.violation);
  chain.search_id = individual.id;
  chain.reference_id = reference.id;
  repairs_.push_back(std::move(chain));
}

void Genocop::finish_repair(RepairChain chain, const Individual& point, RandomStream& random) {
  if (!point.evaluation.feasible()) {
    if (chain.tries() < settings_.max_repair_tries) repairs_.push_back(std::move(chain));
    return;
  }
  enter_references(point, chain.reference_id);
  const bool replace = random.chance(settings_.replacement_probability);
  for (Individual& member : search_) {
    if (member.id != chain.search_id) continue;
    member.repaired_objective = point.evaluation.objective;
    if (replace) member = point;
  }
}

}  // namespace emax
