#include "host/genocop/convex_program.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace emax {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// The share of dv, at most 1, by which v may move before a component reaches zero.
double room(const Vector& v, const Vector& dv) {
  double step = 1;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (dv[i] < 0) step = std::min(step, -v[i] / dv[i]);
  }
  return step;
}

// The program with rows of length 1 and an objective of size 1; t is the last variable.
struct Scaled {
  Matrix hessian, rows;
  Vector gradient, bounds, row_scale;
  double objective_scale;
};

Scaled scaled(const ConvexProgram& p) {
  const Eigen::Index n = p.gradient.size();
  const Eigen::Index m = p.bounds.size();
  const Eigen::Index extra = p.elastic > 0 ? 1 : 0;
  Scaled s;
  s.hessian = Matrix::Zero(n + extra, n + extra);
  s.hessian.topLeftCorner(n, n) = p.hessian;
  s.gradient = Vector::Zero(n + extra);
  s.gradient.head(n) = p.gradient;
  s.rows = Matrix::Zero(m + extra, n + extra);
  s.rows.topLeftCorner(m, n) = p.rows;
  s.bounds = Vector::Zero(m + extra);
  s.bounds.head(m) = p.bounds;
  if (extra > 0) {
    s.gradient[n] = p.penalty;
    s.rows.col(n).head(p.elastic).setConstant(-1);
    s.rows(m, n) = -1;
  }
  s.row_scale = s.rows.rowwise().norm();
  for (Eigen::Index i = 0; i < s.row_scale.size(); ++i) {
    if (s.row_scale[i] == 0) s.row_scale[i] = 1;
    s.rows.row(i) /= s.row_scale[i];
    s.bounds[i] /= s.row_scale[i];
  }
  s.objective_scale = std::max(s.gradient.cwiseAbs().maxCoeff(), s.hessian.cwiseAbs().maxCoeff());
  if (s.objective_scale == 0) s.objective_scale = 1;
  s.gradient /= s.objective_scale;
  s.hessian /= s.objective_scale;
  return s;
}

}  // namespace

ConvexSolution solve(const ConvexProgram& program) {
  const Scaled p = scaled(program);
  const Eigen::Index n = program.gradient.size();
  const Eigen::Index m = p.bounds.size();
  Vector x = Vector::Zero(p.gradient.size());
  Vector slack = (p.bounds - p.rows * x).cwiseMax(0.1);
  Vector dual = Vector::Ones(m);
  ConvexSolution solution;
  constexpr int kMostSteps = 60;
  constexpr double kTolerance = 1e-11;
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector stationarity = p.hessian * x + p.gradient + p.rows.transpose() * dual;
    const Vector feasibility = p.rows * x + slack - p.bounds;
    const double gap = slack.dot(dual) / static_cast<double>(m);
    if (stationarity.cwiseAbs().maxCoeff() < 1e-9 &&
        feasibility.cwiseAbs().maxCoeff() < kTolerance && gap < kTolerance) {
      solution.converged = true;
      break;
    }
    const Vector weights = dual.cwiseQuotient(slack);
    Matrix normal = p.hessian + p.rows.transpose() * weights.asDiagonal() * p.rows;
    normal.diagonal().array() += 1e-13;
    const Eigen::LDLT<Matrix> factor(normal);
    // complementarity: slack * dual + slack * d_dual + dual * d_slack = target
    const auto direction = [&](const Vector& target, Vector& dx, Vector& d_slack, Vector& d_dual) {
      const Vector pull = (target + dual.cwiseProduct(feasibility)).cwiseQuotient(slack);
      dx = factor.solve(-stationarity - p.rows.transpose() * pull);
      d_slack = -feasibility - p.rows * dx;
      d_dual = (target - dual.cwiseProduct(d_slack)).cwiseQuotient(slack);
    };
    Vector dx, d_slack, d_dual;
    const Vector complementarity = slack.cwiseProduct(dual);
    direction(-complementarity, dx, d_slack, d_dual);
    const double primal = room(slack, d_slack);
    const double dual_room = room(dual, d_dual);
    const double reached =
        (slack + primal * d_slack).dot(dual + dual_room * d_dual) / static_cast<double>(m);
    const double ratio = reached / gap;
    const double centre = ratio * ratio * ratio * gap;
    direction(Vector::Constant(m, centre) - complementarity - d_slack.cwiseProduct(d_dual), dx,
              d_slack, d_dual);
    if (!dx.allFinite() || !d_dual.allFinite()) break;
    // One step length for both, because a quadratic objective couples primal and dual.
    const double length = 0.995 * std::min(room(slack, d_slack), room(dual, d_dual));
    x += length * dx;
    slack += length * d_slack;
    dual += length * d_dual;
    if (length < 1e-10) break;
  }
  solution.x = x.head(n);
  solution.excess = x.size() > n ? x[n] : 0;
  solution.multipliers =
      dual.head(program.bounds.size()).cwiseQuotient(p.row_scale.head(program.bounds.size())) *
      p.objective_scale;
  return solution;
}

}  // namespace emax
