#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "host/genocop/linear_domain.h"
#include "host/genocop/random_stream.h"

namespace emax {

// The input of an operator. Parents are inside the domain, better ones first. Their number is that
// of the operator's entry below. They may repeat.
struct OperatorInput {
  const LinearDomain& domain;
  std::span<const Genes> parents;
  double remaining = 1;               // of the budget that is not spent: 1 - t/T
  std::size_t non_uniform_power = 2;  // b of the non-uniform mutations
  double gaussian_sigma = 0.1;        // at the start, in feasible ranges of the gene
};

// A child inside domain and linear constraints (LinearDomain::pull_inside towards a parent).
using Operator = Genes (*)(const OperatorInput& input, RandomStream& random);

// Crossovers: a p0 + (1-a) p1; the same only for the genes after a random cut; p0 + a (p0 - p1).
Genes whole_arithmetical_crossover(const OperatorInput& input, RandomStream& random);
Genes simple_arithmetical_crossover(const OperatorInput& input, RandomStream& random);
Genes heuristic_crossover(const OperatorInput& input, RandomStream& random);

// Mutations of one gene, or of all in random order ("whole"), each within its feasible range with
// the others held: uniform in the range; at one end; a step towards one end that shrinks with the
// budget left, (end - x) u remaining^b; a normal step with a deviation of gaussian_sigma *
// remaining ranges.
Genes uniform_mutation(const OperatorInput& input, RandomStream& random);
Genes whole_uniform_mutation(const OperatorInput& input, RandomStream& random);
Genes boundary_mutation(const OperatorInput& input, RandomStream& random);
Genes non_uniform_mutation(const OperatorInput& input, RandomStream& random);
Genes whole_non_uniform_mutation(const OperatorInput& input, RandomStream& random);
Genes gaussian_mutation(const OperatorInput& input, RandomStream& random);

// Operators of many parents: each gene from a random parent; the worst parent reflected through the
// mean of the others (a simplex step of random length).
Genes pool_recombination(const OperatorInput& input, RandomStream& random);
Genes scatter_search(const OperatorInput& input, RandomStream& random);

struct OperatorEntry {
  std::string_view name;  // in configuration files and logs
  std::size_t parents;
  double standard_frequency;
  Operator apply;
};

// The ten operators of Genocop III and, as the first mutation, Genocop's uniform mutation of one
// gene.
inline constexpr std::size_t kMostParents = 4;
inline constexpr std::array<OperatorEntry, 11> kOperators = {{
    {"whole_arithmetical_crossover", 2, 1, whole_arithmetical_crossover},
    {"simple_arithmetical_crossover", 2, 1, simple_arithmetical_crossover},
    {"heuristic_crossover", 2, 1, heuristic_crossover},
    {"uniform_mutation", 1, 1, uniform_mutation},
    {"whole_uniform_mutation", 1, 1, whole_uniform_mutation},
    {"boundary_mutation", 1, 1, boundary_mutation},
    {"non_uniform_mutation", 1, 1, non_uniform_mutation},
    {"whole_non_uniform_mutation", 1, 1, whole_non_uniform_mutation},
    {"gaussian_mutation", 1, 1, gaussian_mutation},
    {"pool_recombination", kMostParents, 1, pool_recombination},
    {"scatter_search", kMostParents, 1, scatter_search},
}};

}  // namespace emax
