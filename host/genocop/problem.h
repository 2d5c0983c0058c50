#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace emax {

// Values of the genes in the problem's order; those of integer genes are whole.
using Genes = std::vector<double>;

struct Gene {
  enum class Kind { kContinuous, kInteger };

  std::string name;
  Kind kind = Kind::kContinuous;
  double lower = 0;  // domain, both ends included; equal ends fix the gene
  double upper = 0;

  bool operator==(const Gene&) const = default;
};

// sum of coefficient * gene (by position) <= bound, or == bound.
struct LinearConstraint {
  enum class Relation { kAtMost, kEqual };

  std::vector<std::pair<std::size_t, double>> terms;
  Relation relation = Relation::kAtMost;
  double bound = 0;

  bool operator==(const LinearConstraint&) const = default;
};

// What is to be minimised is known only through evaluations.
struct Problem {
  std::vector<Gene> genes;
  std::vector<LinearConstraint> linear;
  std::vector<Genes> starts;  // evaluated first, in this order; each inside domains and `linear`

  // A gene along which, all others held, the objective falls and the violation rises (nearly).
  std::optional<std::size_t> monotone_gene;
};

struct Evaluation {
  bool evaluated_ok = false;  // false: the evaluation crashed or was killed; worst of all
  double objective = 0;       // minimised
  double violation = 0;  // of the most violated nonlinear constraint, normalised; <= 0 feasible

  bool feasible() const { return evaluated_ok && violation <= 0; }
};

}  // namespace emax
