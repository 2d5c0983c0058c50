// Genocop III for a function of your own. It minimises the function with few evaluations, under
// domains, linear and nonlinear constraints, with real, whole and categorical variables.
//
//   #include <emax/genocop.h>
//
//   emax::Problem problem;
//   problem.genes = {{.name = "x", .lower = -5, .upper = 5},
//                    {.name = "y", .lower = -5, .upper = 5}};
//   problem.nonlinear = {{}};                                                     // value <= 0
//   const emax::Minimum found = emax::minimize(problem, [&](const emax::Genes& g) {
//     return emax::make_evaluation(problem.nonlinear, g[0] * g[0] + g[1] * g[1],   // minimised
//                                  {1 - g[0] - g[1]});                          // x + y >= 1
//   }, {.budget = 200, .seed = 1});
//
// Links with emax::genocop. Source: section 2.3; Michalewicz & Nazhiyath (1995). docs/genocop3.md
// lists the differences from it.
#pragma once

#include <emax/error.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace emax {
inline namespace v1 {

// Values of the genes in the problem's order; those of integer and categorical genes are whole.
using Genes = std::vector<double>;

struct Gene {
  // Categories are the whole numbers of the domain. They have no order: none is between two others.
  enum class Kind { kContinuous, kInteger, kCategorical };
  struct Condition {
    std::size_t gene;  // a categorical gene that is itself unconditional
    double category;
    bool unless = false;  // holds with every other category instead

    // Whether the condition holds when that gene has this value.
    bool holds(double value) const { return (value == category) != unless; }
    bool operator==(const Condition&) const = default;
  };

  std::string name;
  Kind kind = Kind::kContinuous;
  double lower = 0;  // domain, both ends included; equal ends fix the gene
  double upper = 0;
  // The gene has a meaning only where the condition holds. Elsewhere points that differ only in
  // this gene are equal.
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

// value <= 0, or |value| <= tolerance. Values are normalised, so that violations are comparable.
struct NonlinearConstraint {
  LinearConstraint::Relation relation = LinearConstraint::Relation::kAtMost;
  double tolerance = 0;  // of an equality

  double violation(double value) const {
    return relation == LinearConstraint::Relation::kEqual ? std::abs(value) - tolerance : value;
  }
  bool operator==(const NonlinearConstraint&) const = default;
};

struct Evaluation {
  bool evaluated_ok = false;  // false: the evaluation crashed or was killed; ranks last
  double objective = 0;       // minimised
  double violation = 0;  // of the most violated nonlinear constraint, normalised; <= 0: feasible
  std::vector<double> constraints = {};  // the values of Problem::nonlinear

  bool feasible() const { return evaluated_ok && violation <= 0; }
};

// A problem whose objective is known only through evaluations.
struct Problem {
  std::vector<Gene> genes;
  std::vector<LinearConstraint> linear;
  // May stay empty where evaluations give only the greatest violation. Local models of the single
  // values are better than one model of their maximum.
  std::vector<NonlinearConstraint> nonlinear;
  std::vector<Genes> starts;  // evaluated first, in this order; each inside domains and `linear`
  // Results known from before (a warm start). They are not charged to the budget and, with the
  // cache, not evaluated again.
  std::vector<std::pair<Genes, Evaluation>> known;

  bool stepped = false;  // the objective moves in steps, so that a local search is of no use
  // A gene along which the objective falls and the violation rises (nearly), with all others held.
  std::optional<std::size_t> monotone_gene;
};

// Makes an evaluation from its parts; it counts as failed if a number is not finite. Throws Error
// if the number of constraints is not the problem's.
EMAX_API Evaluation make_evaluation(const std::vector<NonlinearConstraint>& nonlinear,
                                    double objective, std::vector<double> constraints);

struct MinimizeOptions {
  std::size_t budget = 150;  // evaluations
  std::uint64_t seed = 1;
  // Number of evaluations that run at a time, each in a thread; `evaluate` must permit it.
  std::size_t jobs = 1;
  // Called between evaluations; true ends the search with the result so far.
  std::function<bool()> interrupted = nullptr;
};

struct Minimum {
  Genes genes;
  Evaluation evaluation;        // feasible, or of the least violation if nothing feasible was found
  std::size_t evaluations = 0;  // made
};

// The result is the same for any number of jobs. An exception from `evaluate` ends the search and
// is passed on; return Evaluation{} for an evaluation that fails. Throws Error for a problem
// without genes, for an empty domain, for constraints, starts and known results that do not fit the
// genes, and if nothing was evaluated. Without the evaluations it takes O(budget * (budget * genes
// + (genes + constraints)^3)).
EMAX_API Minimum minimize(const Problem& problem,
                          const std::function<Evaluation(const Genes&)>& evaluate,
                          const MinimizeOptions& options = {});

}  // namespace v1
}  // namespace emax
