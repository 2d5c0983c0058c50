#include "host/genocop/differential_evolution.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace emax {
namespace {

constexpr double kScale = 0.5;      // F
constexpr double kCrossover = 0.5;  // CR
constexpr double kAlike = 1e-9;     // of the domains
constexpr std::size_t kLeastMembers = 16;

bool at_least_as_good(const Evaluation& a, const Evaluation& b) {
  if (a.feasible() != b.feasible()) return a.feasible();
  return a.feasible() ? a.objective <= b.objective : a.violation <= b.violation;
}

// Halfway to a bound that a gene would leave its domain by.
double inside(const Gene& gene, double from, double to) {
  if (to < gene.lower) return (from + gene.lower) / 2;
  if (to > gene.upper) return (from + gene.upper) / 2;
  return to;
}

}  // namespace

DifferentialEvolution::DifferentialEvolution(const LinearDomain& domain)
    : domain_(domain), members_(std::max(kLeastMembers, domain.movable().size() * 5 / 4)) {}

Genes DifferentialEvolution::child(const Member& member, const Member& base, const Member& plus,
                                   const Member& minus, RandomStream& random) const {
  const std::vector<std::size_t>& movable = domain_.movable();
  const std::size_t always = movable[random.below(movable.size())];
  Genes made = member.free;
  for (const std::size_t k : movable) {
    if (!random.chance(kCrossover) && k != always) continue;
    const Gene& gene = domain_.gene(k);
    made[k] =
        gene.kind == Gene::Kind::kCategorical
            ? base.free[k]
            : inside(gene, member.free[k], base.free[k] + kScale * (plus.free[k] - minus.free[k]));
  }
  return domain_.pull_inside(made, member.free);
}

std::optional<DifferentialEvolution::Trial> DifferentialEvolution::propose(
    const std::function<Genes()>& start, RandomStream& random) {
  const std::size_t member = next_;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (i != member && members_[i]) others.push_back(i);
  }
  next_ = (next_ + 1) % members_.size();
  if (!members_[member]) return Trial{start(), member};
  std::array<std::size_t, 3> chosen{};
  if (others.size() < chosen.size()) return std::nullopt;
  for (std::size_t& choice : chosen) {
    const std::size_t at = random.below(others.size());
    choice = others[at];
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
  }
  return Trial{child(*members_[member], *members_[chosen[0]], *members_[chosen[1]],
                     *members_[chosen[2]], random),
               member};
}

void DifferentialEvolution::told(std::size_t member, const Genes& free,
                                 const Evaluation& evaluation) {
  if (!evaluation.evaluated_ok) return;
  std::optional<Member>& old = members_[member];
  if (old && !at_least_as_good(evaluation, old->evaluation)) return;
  old = Member{free, evaluation};
  if (member == 0 && all_alike()) std::ranges::fill(members_, std::nullopt);
}

bool DifferentialEvolution::all_alike() const {
  return std::ranges::all_of(domain_.movable(), [&](std::size_t k) {
    const double width = domain_.gene(k).upper - domain_.gene(k).lower;
    return std::ranges::all_of(members_, [&](const std::optional<Member>& other) {
      return other && std::abs(other->free[k] - members_[0]->free[k]) <= kAlike * width;
    });
  });
}

}  // namespace emax
