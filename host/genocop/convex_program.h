#pragma once

#include <Eigen/Core>

namespace emax {

// min x'Hx/2 + g'x + penalty t, subject to Ax <= b + t for the first `elastic` rows, Ax <= b for
// the other rows, t >= 0 (t only where elastic > 0). H is symmetric and positive semidefinite, or
// zero. The rows bound x on every side, as a trust region does, and their set has an inside.
struct ConvexProgram {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd rows;
  Eigen::VectorXd bounds;
  Eigen::Index elastic = 0;
  double penalty = 0;
};

struct ConvexSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;  // of the rows, >= 0
  double excess = 0;            // t
  bool converged = false;       // to about 1e-9 of the scale of the data
};

// A primal-dual interior point method with predictor and corrector (Mehrotra 1992; Nocedal &
// Wright 2006, chapters 14 and 16). O(n^2 rows) a step, at most 60 steps.
ConvexSolution solve(const ConvexProgram& program);

}  // namespace emax
