#include <emax/genocop.h>

#include <algorithm>
#include <string>

namespace emax {
inline namespace v1 {

Evaluation make_evaluation(const std::vector<NonlinearConstraint>& nonlinear, double objective,
                           std::vector<double> constraints) {
  if (constraints.size() != nonlinear.size()) {
    throw Error("constraints: " + std::to_string(constraints.size()) + " values, the problem has " +
                std::to_string(nonlinear.size()));
  }
  Evaluation evaluation{std::isfinite(objective), objective, nonlinear.empty() ? -1.0 : -HUGE_VAL,
                        std::move(constraints)};
  for (std::size_t c = 0; c < nonlinear.size(); ++c) {
    const double value = evaluation.constraints[c];
    evaluation.evaluated_ok = evaluation.evaluated_ok && std::isfinite(value);
    evaluation.violation = std::max(evaluation.violation, nonlinear[c].violation(value));
  }
  return evaluation;
}

}  // namespace v1
}  // namespace emax
