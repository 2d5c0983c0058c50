#include "host/genocop/linear_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sw_model/base/error.h"

namespace emax {
namespace {

bool within(const Gene& gene, double value) {
  return value >= gene.lower && value <= gene.upper &&
         (!gene.is_whole() || value == std::round(value));
}

double left_side(const LinearConstraint& constraint, const Genes& genes) {
  double sum = 0;
  for (const auto& [gene, coefficient] : constraint.terms) sum += coefficient * genes[gene];
  return sum;
}

void check(const Problem& problem) {
  if (problem.genes.empty()) throw Error("the problem has no genes; give it at least one");
  for (const Gene& gene : problem.genes) {
    const bool integer = gene.is_whole();
    const bool holds_value =
        integer ? std::ceil(gene.lower) <= std::floor(gene.upper) : gene.lower <= gene.upper;
    if (!std::isfinite(gene.lower) || !std::isfinite(gene.upper) || !holds_value) {
      throw Error(
          fmt::format("gene {}: the domain {} to {} holds no {}; give finite lower <= upper",
                      gene.name, gene.lower, gene.upper, integer ? "integer" : "number"));
    }
  }
  for (const Gene& gene : problem.genes) {
    if (!gene.only_with) continue;
    const auto [other, category, unless] = *gene.only_with;
    const bool sound = other < problem.genes.size() &&
                       problem.genes[other].kind == Gene::Kind::kCategorical &&
                       !problem.genes[other].only_with && category == std::round(category);
    if (!sound) {
      throw Error(fmt::format(
          "gene {}: only_with must name a categorical gene that is itself unconditional, and "
          "a whole number",
          gene.name));
    }
  }
  for (std::size_t s = 0; s < problem.starts.size(); ++s) {
    if (problem.starts[s].size() == problem.genes.size()) continue;
    throw Error(fmt::format("start point {}: {} genes, the problem has {}", s + 1,
                            problem.starts[s].size(), problem.genes.size()));
  }
  if (problem.monotone_gene &&
      (*problem.monotone_gene >= problem.genes.size() ||
       problem.genes[*problem.monotone_gene].kind == Gene::Kind::kCategorical)) {
    throw Error("the monotone gene must be a continuous or integer gene of the problem");
  }
  for (const LinearConstraint& constraint : problem.linear) {
    for (const auto& [gene, coefficient] : constraint.terms) {
      if (gene >= problem.genes.size()) {
        throw Error(
            fmt::format("a linear constraint names gene {} of {}", gene + 1, problem.genes.size()));
      }
      if (problem.genes[gene].kind != Gene::Kind::kCategorical) continue;
      throw Error(
          fmt::format("gene {}: categories have no order, so no linear constraint can hold "
                      "it; make it an integer gene",
                      problem.genes[gene].name));
    }
  }
}

}  // namespace

LinearDomain::LinearDomain(const Problem& problem) : genes_(problem.genes) {
  check(problem);
  for (Gene& gene : genes_) {
    if (!gene.is_whole()) continue;
    gene.lower = std::ceil(gene.lower);
    gene.upper = std::floor(gene.upper);
  }
  for (const LinearConstraint& constraint : problem.linear) {
    if (constraint.relation == LinearConstraint::Relation::kAtMost) {
      inequalities_.push_back(constraint);
    }
  }
  solve_equalities(problem);
  reduce_inequalities();
  for (std::size_t k = 0; k < size(); ++k) {
    if (gene(k).lower < gene(k).upper) movable_.push_back(k);
    conditions_.push_back(gene(k).only_with);
    if (conditions_[k]) conditions_[k]->gene = coordinate(conditions_[k]->gene);
  }
  find_inside(problem);
}

std::vector<std::size_t> LinearDomain::movable_with_meaning(const Genes& free) const {
  std::vector<std::size_t> chosen = movable_;
  std::erase_if(chosen, [&](std::size_t k) { return !has_meaning(free, k); });
  return chosen;
}

// Gauss-Jordan elimination. Each equality is solved for the continuous gene with the greatest
// remaining coefficient. The monotone gene is not solved for: a solved gene can be neither rounded
// nor stepped along.
void LinearDomain::solve_equalities(const Problem& problem) {
  const std::size_t count = genes_.size();
  std::vector<Row> equalities;
  for (const LinearConstraint& constraint : problem.linear) {
    if (constraint.relation == LinearConstraint::Relation::kAtMost) continue;
    Row row{std::vector<double>(count, 0.0), constraint.bound};
    for (const auto& [gene, coefficient] : constraint.terms) {
      const Gene& g = genes_[gene];
      if (g.lower == g.upper) {
        row.bound -= coefficient * g.lower;
      } else {
        row.weights[gene] += coefficient;
      }
    }
    equalities.push_back(std::move(row));
  }
  std::vector<std::size_t> pivots;
  for (std::size_t e = 0; e < equalities.size(); ++e) {
    Row& row = equalities[e];
    std::size_t pivot = count;
    double greatest = 0;
    for (std::size_t g = 0; g < count; ++g) {
      const double magnitude = std::abs(row.weights[g]);
      greatest = std::max(greatest, magnitude);
      if (genes_[g].is_whole() || problem.monotone_gene == g) continue;
      if (magnitude > 1e-12 && (pivot == count || magnitude > std::abs(row.weights[pivot]))) {
        pivot = g;
      }
    }
    if (pivot == count) {
      if (greatest <= 1e-12 && std::abs(row.bound) <= 1e-12) continue;  // follows from the others
      throw Error(fmt::format(
          "linear equality {}: contradicts the others or binds no free continuous gene; remove it",
          e + 1));
    }
    const double scale = row.weights[pivot];
    for (double& weight : row.weights) weight /= scale;
    row.bound /= scale;
    row.weights[pivot] = 1;
    for (Row& other : equalities) {
      if (&other == &row) continue;
      const double factor = other.weights[pivot];
      if (factor == 0) continue;
      for (std::size_t g = 0; g < count; ++g) other.weights[g] -= factor * row.weights[g];
      other.weights[pivot] = 0;
      other.bound -= factor * row.bound;
    }
    solved_.push_back({pivot, 0, {}});
    pivots.push_back(e);
  }
  for (std::size_t g = 0; g < count; ++g) {
    const bool is_solved = std::any_of(solved_.begin(), solved_.end(),
                                       [g](const Solved& solved) { return solved.gene == g; });
    if (!is_solved) free_.push_back(g);
  }
  for (std::size_t s = 0; s < solved_.size(); ++s) {
    const Row& row = equalities[pivots[s]];
    solved_[s].constant = row.bound;
    for (std::size_t g : free_) solved_[s].weights.push_back(-row.weights[g]);
  }
}

void LinearDomain::add_row(Row row) {
  const bool constant = std::all_of(row.weights.begin(), row.weights.end(),
                                    [](double weight) { return weight == 0; });
  if (!constant) rows_.push_back(std::move(row));
}

void LinearDomain::reduce_inequalities() {
  for (const LinearConstraint& constraint : inequalities_) {
    Row row{std::vector<double>(size(), 0.0), constraint.bound};
    for (const auto& [gene, coefficient] : constraint.terms) {
      if (const std::size_t k = coordinate(gene); k < size()) {
        row.weights[k] += coefficient;
        continue;
      }
      for (const Solved& solved : solved_) {
        if (solved.gene != gene) continue;
        row.bound -= coefficient * solved.constant;
        for (std::size_t k = 0; k < size(); ++k) row.weights[k] += coefficient * solved.weights[k];
      }
    }
    add_row(std::move(row));
  }
  for (const Solved& solved : solved_) {
    Row above{solved.weights, genes_[solved.gene].upper - solved.constant};
    Row below{solved.weights, solved.constant - genes_[solved.gene].lower};
    for (double& weight : below.weights) weight = -weight;
    add_row(std::move(above));
    add_row(std::move(below));
  }
}

std::size_t LinearDomain::coordinate(std::size_t gene) const {
  const auto found = std::lower_bound(free_.begin(), free_.end(), gene);
  return found != free_.end() && *found == gene ? static_cast<std::size_t>(found - free_.begin())
                                                : size();
}

Genes LinearDomain::complete(const Genes& free) const {
  Genes genes(genes_.size());
  for (std::size_t k = 0; k < size(); ++k) genes[free_[k]] = free[k];
  for (const Solved& solved : solved_) {
    double value = solved.constant;
    for (std::size_t k = 0; k < size(); ++k) value += solved.weights[k] * free[k];
    genes[solved.gene] = value;
  }
  return genes;
}

Genes LinearDomain::reduce(const Genes& genes) const {
  Genes free;
  for (std::size_t g : free_) free.push_back(genes[g]);
  return free;
}

bool LinearDomain::contains(const Genes& free) const {
  const Genes genes = complete(free);
  for (std::size_t g = 0; g < genes.size(); ++g) {
    if (!within(genes_[g], genes[g])) return false;
  }
  return std::all_of(inequalities_.begin(), inequalities_.end(),
                     [&](const LinearConstraint& constraint) {
                       return left_side(constraint, genes) <= constraint.bound;
                     });
}

Interval LinearDomain::range(const Genes& free, std::size_t k) const {
  Interval interval{gene(k).lower, gene(k).upper};
  for (const Row& row : rows_) {
    const double weight = row.weights[k];
    if (weight == 0) continue;
    double rest = row.bound;
    for (std::size_t j = 0; j < size(); ++j) {
      if (j != k) rest -= row.weights[j] * free[j];
    }
    const double end = rest / weight;
    if (weight > 0) interval.upper = std::min(interval.upper, end);
    if (weight < 0) interval.lower = std::max(interval.lower, end);
  }
  if (gene(k).is_whole()) {
    // The slack keeps an end that is whole except for rounding; pull_inside checks the point.
    constexpr double kSlack = 1e-9;
    interval.lower = std::ceil(interval.lower - kSlack);
    interval.upper = std::floor(interval.upper + kSlack);
  }
  if (!(interval.lower <= interval.upper)) return {free[k], free[k]};
  return interval;
}

Genes LinearDomain::snap(const Genes& free) const {
  Genes result(size());
  for (std::size_t k = 0; k < size(); ++k) {
    const double value = gene(k).is_whole() ? std::round(free[k]) : free[k];
    result[k] = std::clamp(value, gene(k).lower, gene(k).upper) + 0.0;  // no negative zero
  }
  return result;
}

Genes LinearDomain::pull_inside(const Genes& child, const Genes& anchor) const {
  if (Genes snapped = snap(child); contains(snapped)) return snapped;
  double limit = 1;
  for (const Row& row : rows_) {
    double along = 0;
    double room = row.bound;
    for (std::size_t k = 0; k < size(); ++k) {
      const double target = std::clamp(child[k], gene(k).lower, gene(k).upper);
      along += row.weights[k] * (target - anchor[k]);
      room -= row.weights[k] * anchor[k];
    }
    if (along > 0) limit = std::min(limit, std::max(room, 0.0) / along);
  }
  // The first steps back have the size of roundings, so that a child on the boundary stays there.
  // The larger ones are for integers that rounding moves outside.
  constexpr double kRetreat[] = {0,     0x1p-50, 0x1p-46, 0x1p-40, 0x1p-30, 0x1p-20, 0x1p-10,
                                 0.125, 0.25,    0.5,     0.75,    0.875,   0.9375};
  Genes point(size());
  for (double retreat : kRetreat) {
    const double step = limit * (1 - retreat);
    for (std::size_t k = 0; k < size(); ++k) {
      const double target = std::clamp(child[k], gene(k).lower, gene(k).upper);
      point[k] = gene(k).kind == Gene::Kind::kCategorical ? target
                                                          : anchor[k] + step * (target - anchor[k]);
    }
    if (Genes snapped = snap(point); contains(snapped)) return snapped;
  }
  return anchor;
}

Genes LinearDomain::from_unit_cube(const std::vector<double>& position,
                                   RandomStream& random) const {
  Genes point(size());
  for (std::size_t k = 0; k < size(); ++k) {
    const Gene& g = gene(k);
    point[k] = g.is_whole() ? g.lower + std::floor(position[k] * (g.upper - g.lower + 1))
                            : g.lower + position[k] * (g.upper - g.lower);
  }
  point = snap(point);
  if (contains(point)) return point;
  constexpr int kRounds = 4;  // of coordinate-wise uniform steps (a Gibbs sampler)
  point = inside_;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k : random.permutation(size())) {
      Genes next = point;
      const Interval interval = range(point, k);
      next[k] = gene(k).is_whole()
                    ? interval.lower +
                          static_cast<double>(random.below(
                              static_cast<std::uint64_t>(interval.upper - interval.lower) + 1))
                    : random.uniform(interval.lower, interval.upper);
      point = pull_inside(next, point);
    }
  }
  return point;
}

Genes LinearDomain::sample(RandomStream& random) const {
  std::vector<double> position(size());
  for (double& p : position) p = random.uniform();
  return from_unit_cube(position, random);
}

// Relaxation (Motzkin & Schoenberg 1954): it steps repeatedly through the most violated inequality.
// It may converge to a boundary, so it aims a depth inside, which shrinks with the restarts.
void LinearDomain::find_inside(const Problem& problem) {
  for (std::size_t s = 0; s < problem.starts.size(); ++s) {
    const Genes free = reduce(problem.starts[s]);
    const Genes genes = complete(free);
    bool same = contains(free);
    for (std::size_t g = 0; same && g < genes.size(); ++g) {
      same = std::abs(genes[g] - problem.starts[s][g]) <=
             1e-9 * (1 + genes_[g].upper - genes_[g].lower);
    }
    if (!same) {
      throw Error(fmt::format(
          "start point {}: outside a domain or a linear constraint; move it inside", s + 1));
    }
    if (s == 0) inside_ = free;
  }
  if (!problem.starts.empty()) return;
  constexpr int kRestarts = 20;
  constexpr int kSteps = 2000;
  constexpr double kOvershoot = 1.5;
  double depth = 0.05;  // in widths of the domains, weighted by the row
  RandomStream random(0, 0, RandomStream::Purpose::kDomain);
  for (int restart = 0; restart < kRestarts; ++restart, depth /= 4) {
    Genes point(size());
    for (std::size_t k = 0; k < size(); ++k) {
      const double share = restart == 0 ? 0.5 : random.uniform();
      point[k] = gene(k).lower + share * (gene(k).upper - gene(k).lower);
    }
    for (int step = 0; step < kSteps; ++step) {
      if (Genes snapped = snap(point); contains(snapped)) {
        inside_ = std::move(snapped);
        return;
      }
      const Row* worst = nullptr;
      double worst_excess = 0;
      double worst_norm = 1;
      for (const Row& row : rows_) {
        double excess = -row.bound;
        double norm = 0;
        for (std::size_t k = 0; k < size(); ++k) {
          excess += row.weights[k] * point[k];
          norm += row.weights[k] * row.weights[k];
          excess += depth * std::abs(row.weights[k]) * (gene(k).upper - gene(k).lower);
        }
        if (excess * std::abs(excess) / norm > worst_excess * worst_excess / worst_norm) {
          worst = &row;
          worst_excess = excess;
          worst_norm = norm;
        }
      }
      if (worst == nullptr) break;  // only rounding to integers puts the point outside
      for (std::size_t k = 0; k < size(); ++k) {
        point[k] = std::clamp(point[k] - kOvershoot * worst_excess / worst_norm * worst->weights[k],
                              gene(k).lower, gene(k).upper);
      }
    }
  }
  throw Error(
      "linear constraints: no point of the domains satisfies them all; relax one, or give a start "
      "point inside");
}

}  // namespace emax
