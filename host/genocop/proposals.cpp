#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "host/genocop/genocop.h"
#include "host/genocop/ranking.h"
#include "host/genocop/sobol.h"

namespace emax {
namespace {

constexpr int kRedraws = 20;     // for a duplicate: first as offspring, then anywhere in the domain
constexpr double kApart = 0.02;  // of the domains: a search starts this far from earlier ones

}  // namespace

// The first candidates: the given starts; the first start at evenly spaced values of the monotone
// gene; then Sobol's sequence or a Latin hypercube, which has one point in each of as many slices
// of every gene.
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
  if (starts_.size() < wanted) make_more_starts(wanted - starts_.size());
  descent_.after_starts = starts_.size();
}

bool Genocop::descent_is_over() const {
  return settings_.restart_after > 0 && finish_ && starts_.empty() &&
         told_ >= std::max(descent_.gained, descent_.after_starts) + settings_.restart_after;
}

// What was evaluated stays known: to the cache, the operators' frequencies and the best point.
void Genocop::begin_anew() {
  search_.clear();
  references_.clear();
  repairs_.clear();
  finished_.clear();
  finish_reference_.reset();
  finish_->stop();
  if (linear_) linear_->forget();
  descent_ = Descent{};
  descent_.first = asked();
  make_more_starts(std::max<std::size_t>(settings_.search_population, settings_.look_ahead));
  descent_.after_starts = asked() + starts_.size();
}

Genes Genocop::next_of_sobol(RandomStream& random) {
  const auto index = static_cast<std::uint32_t>(sampled_++);
  return domain_.from_unit_cube(sobol_point(seed_, index, domain_.size()), random);
}

void Genocop::make_more_starts(std::size_t count) {
  RandomStream random(seed_, asked(), RandomStream::Purpose::kStart);
  if (settings_.sobol_starts) {
    for (std::size_t i = 0; i < count; ++i) starts_.push_back(next_of_sobol(random));
    return;
  }
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
  if (descent_is_over()) begin_anew();
  RandomStream random(seed_, index, RandomStream::Purpose::kAsk);
  Proposal proposal = propose(random);
  Candidate candidate{index, domain_.complete(proposal.free), proposal.origin, {}, {}};
  if (settings_.cache) {
    const Genes key = cache_key(proposal.free);
    const auto [entry, fresh] = first_.try_emplace(key, index);
    if (!fresh) {
      candidate.same_as = entry->second;
    } else if (const auto before = known_.find(key); before != known_.end()) {
      candidate.known = before->second;
    }
  }
  if (monotone_) monotone_->asked(proposal.free);
  if (proposal.role == Role::kFinish) finish_->asked(proposal.free);
  records_.push_back({std::move(proposal.free), proposal.role, candidate.same_as || candidate.known,
                      std::move(proposal.chain), proposal.bred, proposal.member, std::nullopt});
  return candidate;
}

// Points with the same key count as one. Genes are rounded to the resolution; genes that have no
// meaning with the point's categories are left out.
Genes Genocop::cache_key(const Genes& free) const {
  Genes key = free;
  for (std::size_t k = 0; k < key.size(); ++k) {
    const Gene& gene = domain_.gene(k);
    if (!domain_.has_meaning(free, k)) {
      key[k] = 0;
      continue;
    }
    const double grain = settings_.cache_resolution * (gene.upper - gene.lower);
    if (!gene.is_whole() && grain > 0) key[k] = std::floor((free[k] - gene.lower) / grain + 0.5);
  }
  return key;
}

bool Genocop::is_new(const Genes& free) const {
  if (!settings_.cache) return true;
  const Genes key = cache_key(free);
  return !first_.contains(key) && !known_.contains(key);
}

std::optional<Evaluation> Genocop::result_of(const Genes& cached) const {
  if (const auto known = known_.find(cached); known != known_.end()) return known->second;
  return records_[first_.at(cached)].evaluation;
}

Genocop::Proposal Genocop::propose(RandomStream& random) {
  if (!starts_.empty()) {
    const Genes start = std::move(starts_.front());
    starts_.pop_front();
    if (is_new(start)) return {start, "start"};
  } else if (settings_.first_phase || !references_.empty()) {
    if (std::optional<Proposal> trial = next_differential(random)) return std::move(*trial);
    if (monotone_) {
      if (std::optional<Genes> trial = monotone_->climb(); trial && is_new(*trial)) {
        return {std::move(*trial), "climb", Role::kClimb};
      }
    }
    if (finish_) {
      if (std::optional<Proposal> trial = next_finish(random)) return std::move(*trial);
    }
    if (std::optional<Proposal> repair = next_repair(random)) return std::move(*repair);
    if (linear_ && random.chance(settings_.linear_share)) {
      if (std::optional<Proposal> step = next_linear(random)) return std::move(*step);
    }
    for (int draw = 0; draw < kRedraws; ++draw) {
      std::optional<Proposal> child = offspring(random);
      if (!child) break;
      if (is_new(child->free)) return std::move(*child);
    }
  }
  Genes point = domain_.sample(random);
  for (int draw = 1; draw < kRedraws && !is_new(point); ++draw) point = domain_.sample(random);
  return {std::move(point), "sample"};
}

std::optional<Genocop::Proposal> Genocop::next_linear(RandomStream& random) {
  const std::vector<Individual>& population = references_.empty() ? search_ : references_;
  if (population.empty()) return std::nullopt;
  std::optional<Genes> step =
      linear_->propose(population.front().free, population.front().evaluation, random);
  if (!step || !is_new(*step)) return std::nullopt;
  return Proposal{std::move(*step), "linear_model", Role::kLinear};
}

std::optional<Genocop::Proposal> Genocop::next_finish(RandomStream& random) {
  if (!finish_->running() && !start_finish()) return std::nullopt;
  if (!random.chance(share_of_finish())) return std::nullopt;
  constexpr int kMostKnown = 100;
  for (int known = 0; known < kMostKnown; ++known) {
    std::optional<Genes> trial = finish_->propose();
    if (!trial) break;
    if (is_new(*trial)) return Proposal{std::move(*trial), "finish", Role::kFinish};
    const std::optional<Evaluation> evaluation = result_of(cache_key(*trial));
    if (!evaluation) break;
    finish_->asked(*trial);
    finish_->told(*trial, *evaluation);
  }
  return std::nullopt;
}

// From 0 for eight genes towards 1.
double Genocop::many_genes() const {
  constexpr double kFewGenes = 8;
  const double few = std::min(1.0, kFewGenes / static_cast<double>(domain_.movable().size()));
  return 1 - few * few;
}

// With many genes the points that a model needs would leave a short search only a few steps. Where
// the model predicts well, the other strategies get less.
double Genocop::share_of_finish() const {
  if (!finish_->predicts_well()) return settings_.finish_share;
  return 1 - (1 - settings_.finish_share) * (1 - many_genes());
}

// Where the genes are many, one local search ends in one local optimum and the next in another.
// Differential evolution then crosses between all of them.
std::optional<Genocop::Proposal> Genocop::next_differential(RandomStream& random) {
  const bool has_ended = descent_.first > 0 || finished_.size() > 1;
  if (!differential_ || !has_ended || many_genes() == 0) return std::nullopt;
  if (!random.chance(many_genes())) return std::nullopt;
  const auto start = [&] { return next_of_sobol(random); };
  for (int draw = 0; draw < kRedraws; ++draw) {
    std::optional<DifferentialEvolution::Trial> trial = differential_->propose(start, random);
    if (!trial) break;
    if (!is_new(trial->free)) continue;
    return Proposal{std::move(trial->free), "differential", Role::kDifferential, {}, {},
                    trial->member};
  }
  return std::nullopt;
}

// Starts a local search at the best point of the populations that is far enough from the starts and
// ends of earlier ones.
bool Genocop::start_finish() {
  if (told_ < descent_.after_starts) return false;
  if (const Genes* end = finish_->centre()) {
    finished_.push_back(*end);
    finish_->stop();
  }
  const auto apart = [&](const Genes& free) {
    return std::none_of(finished_.begin(), finished_.end(), [&](const Genes& other) {
      for (std::size_t k : domain_.movable()) {
        if (!domain_.has_meaning(free, k)) continue;
        const Gene& gene = domain_.gene(k);
        const double distance = std::abs(free[k] - other[k]) / (gene.upper - gene.lower);
        if (gene.is_whole() ? distance > 0 : distance > kApart) return false;
      }
      return true;
    });
  };
  for (const auto* population : {&references_, &search_}) {
    for (const Individual& individual : *population) {
      if (!apart(individual.free)) continue;
      finished_.push_back(individual.free);
      finish_reference_.reset();
      finish_->start(individual.free, individual.evaluation, settings_.finish_radius);
      return true;
    }
  }
  return false;
}

std::optional<Genocop::Proposal> Genocop::next_repair(RandomStream& random) {
  while (!repairs_.empty()) {
    RepairChain chain = std::move(repairs_.front());
    repairs_.pop_front();
    Genes point = chain.next(domain_, random);
    if (is_new(point)) return Proposal{std::move(point), "repair", Role::kRepair, chain};
    // A known result is used without a charge. A result that is in flight ends the repair.
    const std::optional<Evaluation> evaluation = result_of(cache_key(point));
    if (!evaluation) continue;
    chain.tell(*evaluation);
    if (!evaluation->feasible() && chain.tries() < settings_.max_repair_tries) {
      repairs_.push_front(std::move(chain));
    } else {
      end_repair(chain, *evaluation);
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

  const std::size_t drawn = frequencies_.draw(random);
  const OperatorEntry& entry = kOperators[drawn];
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
  return Proposal{std::move(child),
                  entry.name,
                  Role::kSearch,
                  {},
                  Bred{drawn, key(population[ranks[0]]), from_references}};
}

double Genocop::remaining() const {
  std::uint64_t budget = settings_.budget;
  for (const std::uint64_t earlier : settings_.earlier_budgets) {
    if (asked() >= earlier) continue;
    budget = earlier;
    break;
  }
  if (asked() >= budget) return 0;
  return static_cast<double>(budget - asked()) / static_cast<double>(budget - descent_.first);
}

}  // namespace emax
