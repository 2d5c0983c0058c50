#include <emax/genocop.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "host/python/bindings.h"

namespace nb = nanobind;

namespace emax {
namespace {

using Kind = Gene::Kind;
using Relation = LinearConstraint::Relation;

Problem problem_of(const std::vector<std::pair<double, double>>& bounds,
                   const std::vector<int>& kinds, const nb::list& linear,
                   const std::vector<std::pair<bool, double>>& nonlinear,
                   const std::vector<Genes>& starts) {
  Problem problem;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    problem.genes.push_back({.name = "x[" + std::to_string(i) + "]",
                             .kind = static_cast<Kind>(kinds[i]),
                             .lower = bounds[i].first,
                             .upper = bounds[i].second});
  }
  for (const nb::handle row : linear) {
    const auto [terms, equal, bound] =
        nb::cast<std::tuple<std::vector<std::pair<std::size_t, double>>, bool, double>>(row);
    problem.linear.push_back({terms, equal ? Relation::kEqual : Relation::kAtMost, bound});
  }
  for (const auto& [equal, tolerance] : nonlinear) {
    problem.nonlinear.push_back({equal ? Relation::kEqual : Relation::kAtMost, tolerance});
  }
  problem.starts = starts;
  return problem;
}

}  // namespace

void bind_minimize(nb::module_& module) {
  // `fun` gives the objective and the values of the nonlinear constraints, or None where it fails.
  module.def(
      "minimize",
      [](const nb::callable& fun, const std::vector<std::pair<double, double>>& bounds,
         const std::vector<int>& kinds, const nb::list& linear,
         const std::vector<std::pair<bool, double>>& nonlinear, const std::vector<Genes>& starts,
         std::size_t budget, std::uint64_t seed, std::size_t jobs, const nb::callable& stopped) {
        const Problem problem = problem_of(bounds, kinds, linear, nonlinear, starts);
        Minimum found;
        {
          const nb::gil_scoped_release released;
          found = minimize(
              problem,
              [&](const Genes& genes) -> Evaluation {
                const nb::gil_scoped_acquire held;
                const nb::object made = fun(genes);
                if (made.is_none()) return {};
                auto [objective, values] = nb::cast<std::pair<double, std::vector<double>>>(made);
                return make_evaluation(problem.nonlinear, objective, std::move(values));
              },
              {.budget = budget, .seed = seed, .jobs = jobs, .interrupted = [&] {
                 const nb::gil_scoped_acquire held;
                 if (PyErr_CheckSignals() != 0) nb::raise_python_error();
                 return nb::cast<bool>(stopped());
               }});
        }
        const Evaluation& e = found.evaluation;
        return nb::make_tuple(found.genes, e.objective, e.evaluated_ok, e.violation, e.constraints,
                              found.evaluations);
      },
      nb::arg("fun"), nb::arg("bounds"), nb::arg("kinds"), nb::arg("linear"), nb::arg("nonlinear"),
      nb::arg("starts"), nb::arg("budget"), nb::arg("seed"), nb::arg("jobs"), nb::arg("stopped"));
}

}  // namespace emax
