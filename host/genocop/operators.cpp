#include "host/genocop/operators.h"

#include <algorithm>
#include <cmath>

namespace emax {
namespace {

bool is_integer(const LinearDomain& domain, std::size_t k) { return domain.gene(k).is_whole(); }

bool is_category(const LinearDomain& domain, std::size_t k) {
  return domain.gene(k).kind == Gene::Kind::kCategorical;
}

// Nothing lies between two categories: if the parents' categories differ, the child gets either.
double mixed(const LinearDomain& domain, std::size_t k, double p, double q, double value,
             RandomStream& random) {
  if (!is_category(domain, k) || p == q) return is_category(domain, k) ? p : value;
  return random.chance(0.5) ? p : q;
}

// A random coordinate that has a meaning; any movable one if all that have a meaning are fixed.
std::size_t random_movable(const LinearDomain& domain, const Genes& parent, RandomStream& random) {
  std::vector<std::size_t> movable = domain.movable_with_meaning(parent);
  if (movable.empty()) movable = domain.movable();
  return movable[random.below(movable.size())];
}

// Sets one coordinate and keeps the child inside.
Genes with_value(const LinearDomain& domain, const Genes& parent, std::size_t k, double value) {
  Genes child = parent;
  child[k] = value;
  return domain.pull_inside(child, parent);
}

// If only one integer is mutated and it did not move, the child would repeat the parent; so it
// moves by one.
double at_least_one_step(const LinearDomain& domain, std::size_t k, double from, double to,
                         bool upwards) {
  if (!is_integer(domain, k) || std::round(to) != from) return to;
  return upwards ? from + 1 : from - 1;
}

Genes uniform_in_range(const LinearDomain& domain, const Genes& parent, std::size_t k,
                       RandomStream& random) {
  const Interval range = domain.range(parent, k);
  if (!is_integer(domain, k)) {
    return with_value(domain, parent, k, random.uniform(range.lower, range.upper));
  }
  const auto count = static_cast<std::uint64_t>(range.upper - range.lower) + 1;
  return with_value(domain, parent, k, range.lower + static_cast<double>(random.below(count)));
}

// Any other category, all with the same probability.
Genes other_category(const LinearDomain& domain, const Genes& parent, std::size_t k,
                     RandomStream& random) {
  const Gene& gene = domain.gene(k);
  double value =
      gene.lower +
      static_cast<double>(random.below(static_cast<std::uint64_t>(gene.upper - gene.lower)));
  if (value >= parent[k]) ++value;
  return with_value(domain, parent, k, value);
}

Genes non_uniform_step(const OperatorInput& input, const Genes& parent, std::size_t k, bool alone,
                       RandomStream& random) {
  if (is_category(input.domain, k)) {
    const bool moves = alone || random.chance(input.remaining / static_cast<double>(parent.size()));
    const bool others = input.domain.gene(k).lower < input.domain.gene(k).upper;
    return moves && others ? other_category(input.domain, parent, k, random) : parent;
  }
  const Interval range = input.domain.range(parent, k);
  const bool upwards = (random.bits() >> 63) != 0;
  double step = ((upwards ? range.upper : range.lower) - parent[k]) * random.uniform();
  for (std::size_t power = 0; power < input.non_uniform_power; ++power) step *= input.remaining;
  double target = parent[k] + step;
  if (alone) target = at_least_one_step(input.domain, k, parent[k], target, upwards);
  return with_value(input.domain, parent, k, std::clamp(target, range.lower, range.upper));
}

}  // namespace

Genes whole_arithmetical_crossover(const OperatorInput& input, RandomStream& random) {
  const Genes& p = input.parents[0];
  const Genes& q = input.parents[1];
  const double share = random.uniform();
  Genes child(p.size());
  for (std::size_t k = 0; k < p.size(); ++k) {
    child[k] = mixed(input.domain, k, p[k], q[k], share * p[k] + (1 - share) * q[k], random);
  }
  return input.domain.pull_inside(child, p);
}

Genes simple_arithmetical_crossover(const OperatorInput& input, RandomStream& random) {
  Genes child = input.parents[0];
  const Genes& q = input.parents[1];
  const double share = random.uniform();
  const std::size_t cut = child.size() > 1 ? 1 + random.below(child.size() - 1) : 0;
  for (std::size_t k = cut; k < child.size(); ++k) {
    child[k] =
        mixed(input.domain, k, q[k], child[k], share * q[k] + (1 - share) * child[k], random);
  }
  return input.domain.pull_inside(child, input.parents[0]);
}

Genes heuristic_crossover(const OperatorInput& input, RandomStream& random) {
  const Genes& better = input.parents[0];
  const Genes& worse = input.parents[1];
  const double length = random.uniform();
  Genes child(better.size());
  for (std::size_t k = 0; k < child.size(); ++k) {
    child[k] =
        is_category(input.domain, k) ? better[k] : better[k] + length * (better[k] - worse[k]);
  }
  return input.domain.pull_inside(child, better);
}

Genes uniform_mutation(const OperatorInput& input, RandomStream& random) {
  const std::size_t k = random_movable(input.domain, input.parents[0], random);
  return uniform_in_range(input.domain, input.parents[0], k, random);
}

Genes whole_uniform_mutation(const OperatorInput& input, RandomStream& random) {
  Genes child = input.parents[0];
  for (std::size_t k : random.permutation(child.size())) {
    child = uniform_in_range(input.domain, child, k, random);
  }
  return child;
}

Genes boundary_mutation(const OperatorInput& input, RandomStream& random) {
  const std::size_t k = random_movable(input.domain, input.parents[0], random);
  if (is_category(input.domain, k)) {
    return other_category(input.domain, input.parents[0], k, random);
  }
  const Interval range = input.domain.range(input.parents[0], k);
  const double end = (random.bits() >> 63) != 0 ? range.upper : range.lower;
  return with_value(input.domain, input.parents[0], k, end);
}

Genes non_uniform_mutation(const OperatorInput& input, RandomStream& random) {
  const std::size_t k = random_movable(input.domain, input.parents[0], random);
  return non_uniform_step(input, input.parents[0], k, true, random);
}

Genes whole_non_uniform_mutation(const OperatorInput& input, RandomStream& random) {
  Genes child = input.parents[0];
  for (std::size_t k : random.permutation(child.size())) {
    child = non_uniform_step(input, child, k, false, random);
  }
  return child;
}

Genes gaussian_mutation(const OperatorInput& input, RandomStream& random) {
  const Genes& parent = input.parents[0];
  const std::size_t k = random_movable(input.domain, parent, random);
  if (is_category(input.domain, k)) return other_category(input.domain, parent, k, random);
  const Interval range = input.domain.range(parent, k);
  const double step =
      random.gaussian() * input.gaussian_sigma * input.remaining * (range.upper - range.lower);
  const double target = at_least_one_step(input.domain, k, parent[k], parent[k] + step, step > 0);
  return with_value(input.domain, parent, k, std::clamp(target, range.lower, range.upper));
}

Genes pool_recombination(const OperatorInput& input, RandomStream& random) {
  Genes child(input.parents[0].size());
  for (std::size_t k = 0; k < child.size(); ++k) {
    child[k] = input.parents[random.below(input.parents.size())][k];
  }
  return input.domain.pull_inside(child, input.parents[0]);
}

Genes scatter_search(const OperatorInput& input, RandomStream& random) {
  const std::size_t others = input.parents.size() - 1;
  const Genes& worst = input.parents[others];
  const double length = random.uniform(0, 2);
  Genes child(worst.size());
  for (std::size_t k = 0; k < child.size(); ++k) {
    double mean = 0;
    for (std::size_t p = 0; p < others; ++p) mean += input.parents[p][k];
    mean /= static_cast<double>(others);
    child[k] = mean + length * (mean - worst[k]);
    if (is_category(input.domain, k)) child[k] = input.parents[random.below(others)][k];
  }
  return input.domain.pull_inside(child, input.parents[0]);
}

}  // namespace emax
