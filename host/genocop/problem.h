#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace emax {

// Values of the genes in the problem's order; those of integer and categorical genes are whole.
using Genes = std::vector<double>;

struct Gene {
  // Categories are the whole numbers of the domain, without order: none is between two others.
  enum class Kind { kContinuous, kInteger, kCategorical };
  struct Condition {
    std::size_t gene;  // a categorical gene that is itself unconditional
    double category;
    bool unless = false;  // with every other category instead
    bool operator==(const Condition&) const = default;
  };

  std::string name;
  Kind kind = Kind::kContinuous;
  double lower = 0;  // domain, both ends included; equal ends fix the gene
  double upper = 0;
  // The gene has a meaning only with that category; elsewhere points that differ in it are equal.
  std::optional<Condition> only_with = std::nullopt;

  bool is_whole() const { return kind != Kind::kContinuous; }
  bool operator==(const Gene&) const = default;
};

// sum of coefficient * gene (by position) <= bound, or == bound; no categorical genes.
struct LinearConstraint {
  enum class Relation { kAtMost, kEqual };

  std::vector<std::pair<std::size_t, double>> terms;
  Relation relation = Relation::kAtMost;
  double bound = 0;

  bool operator==(const LinearConstraint&) const = default;
};

// value <= 0, or |value| <= tolerance; values are normalised, so that violations compare.
struct NonlinearConstraint {
  LinearConstraint::Relation relation = LinearConstraint::Relation::kAtMost;
  double tolerance = 0;  // of an equality

  double violation(double value) const {
    return relation == LinearConstraint::Relation::kEqual ? std::abs(value) - tolerance : value;
  }
  bool operator==(const NonlinearConstraint&) const = default;
};

struct Evaluation {
  bool evaluated_ok = false;  // false: the evaluation crashed or was killed; worst of all
  double objective = 0;       // minimised
  double violation = 0;  // of the most violated nonlinear constraint, normalised; <= 0 feasible
  std::vector<double> constraints = {};  // the values of Problem::nonlinear

  bool feasible() const { return evaluated_ok && violation <= 0; }
};

// What is to be minimised is known only through evaluations.
struct Problem {
  std::vector<Gene> genes;
  std::vector<LinearConstraint> linear;
  // May stay empty where evaluations tell the greatest violation alone; local models of single
  // values are better than one of their maximum.
  std::vector<NonlinearConstraint> nonlinear;
  std::vector<Genes> starts;  // evaluated first, in this order; each inside domains and `linear`
  // Results known from before (a warm start): not charged, and with the cache not asked for again.
  std::vector<std::pair<Genes, Evaluation>> known;

  bool stepped = false;  // the objective moves in steps, so that no local search is worth it
  // A gene along which, all others held, the objective falls and the violation rises (nearly).
  std::optional<std::size_t> monotone_gene;
};

// An evaluation from its parts; failed when a number is not finite.
Evaluation make_evaluation(const std::vector<NonlinearConstraint>& nonlinear, double objective,
                           std::vector<double> constraints);

}  // namespace emax
