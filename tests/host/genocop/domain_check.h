#pragma once

#include <cmath>
#include <string>

#include <emax/genocop.h>

namespace emax::testing_help {

// What a candidate breaks, written without LinearDomain: empty when it keeps domains, whole numbers
// and inequalities exactly, and equalities to 1e-9 of their terms.
inline std::string broken_rule(const Problem& problem, const Genes& genes) {
  if (genes.size() != problem.genes.size()) return "number of genes";
  for (std::size_t i = 0; i < genes.size(); ++i) {
    const Gene& gene = problem.genes[i];
    if (!(genes[i] >= gene.lower && genes[i] <= gene.upper)) return "domain of " + gene.name;
    if (gene.kind == Gene::Kind::kInteger && genes[i] != std::floor(genes[i])) {
      return gene.name + " not whole";
    }
  }
  for (const LinearConstraint& constraint : problem.linear) {
    double sum = 0, scale = std::abs(constraint.bound);
    for (const auto& [gene, coefficient] : constraint.terms) {
      sum += coefficient * genes[gene];
      scale += std::abs(coefficient * genes[gene]);
    }
    if (constraint.relation == LinearConstraint::Relation::kAtMost && !(sum <= constraint.bound)) {
      return "inequality";
    }
    if (constraint.relation == LinearConstraint::Relation::kEqual &&
        !(std::abs(sum - constraint.bound) <= 1e-9 * scale)) {
      return "equality";
    }
  }
  return {};
}

// Continuous, integer, fixed and flag genes, inequalities across kinds, and an equality.
inline Problem mixed_problem() {
  using Kind = Gene::Kind;
  Problem p;
  p.genes = {{"a", Kind::kContinuous, 0, 10},    {"b", Kind::kContinuous, -5, 5},
             {"n", Kind::kInteger, 1, 12},       {"flag", Kind::kInteger, 0, 1},
             {"fixed", Kind::kContinuous, 3, 3}, {"c", Kind::kContinuous, 0, 8},
             {"m", Kind::kInteger, -4, 4}};
  using Relation = LinearConstraint::Relation;
  p.linear = {{{{0, 1.0}, {1, 0.3}, {2, 0.7}}, Relation::kAtMost, 9.1},
              {{{2, -1.0}, {6, 2.0}}, Relation::kAtMost, 1.0},
              {{{0, -0.1}, {3, 1.5}, {4, 0.2}}, Relation::kAtMost, 1.3},
              {{{0, 1.0}, {5, 2.0}, {6, 0.5}}, Relation::kEqual, 11.0}};
  return p;
}

}  // namespace emax::testing_help
