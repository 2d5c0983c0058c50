#include "host/genocop/local_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/genocop/convex_program.h"

namespace emax {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Relation = LinearConstraint::Relation;

// A step aims inside a nonlinear constraint by this much, so that rounding does not decide.
constexpr double kMargin = 1e-9;

std::size_t row_count(const std::vector<NonlinearConstraint>& constraints) {
  std::size_t count = 0;
  for (const NonlinearConstraint& c : constraints) count += c.relation == Relation::kEqual ? 2 : 1;
  return count;
}

Matrix convex(const Matrix& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(symmetric);
  const Vector values = eigen.eigenvalues().cwiseMax(0.0);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

LocalSpace::LocalSpace(const LinearDomain& domain, const Problem& problem,
                       const std::vector<std::size_t>& coordinates, const Genes& at)
    : domain_(domain), constraints_(problem.nonlinear), single_(problem.nonlinear.empty()) {
  for (std::size_t k = 0; k < domain.size(); ++k) is_rest_.push_back(domain.has_meaning(at, k));
  std::ranges::copy_if(coordinates, std::back_inserter(coordinates_),
                       [&](std::size_t k) { return is_rest_[k]; });
  widths_.resize(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const std::size_t k = coordinates_[static_cast<std::size_t>(i)];
    is_rest_[k] = false;
    widths_[i] = domain.gene(k).upper - domain.gene(k).lower;
  }
  if (single_) constraints_.emplace_back();
  scales_ = Vector::Ones(static_cast<Eigen::Index>(constraints_.size()));
}

void LocalSpace::scale(const Vector& scales) {
  scales_ = scales_.cwiseProduct(scales);
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    constraints_[c].tolerance /= scales[static_cast<Eigen::Index>(c)];
  }
}

void LocalSpace::scale(LocalPoint& point, const Vector& scales) const {
  point.responses.tail(scales.size()).array() /= scales.array();
  point.violation = violation(point.responses);
}

Vector LocalSpace::position(const Genes& free) const {
  Vector at(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const std::size_t k = coordinates_[static_cast<std::size_t>(i)];
    at[i] = (free[k] - domain_.gene(k).lower) / widths_[i];
  }
  return at;
}

Genes LocalSpace::moved(const Genes& centre, const Vector& step) const {
  constexpr double kSnap = 1e-10;  // of the width: an interior point method ends before a bound
  Genes free = centre;
  for (Eigen::Index i = 0; i < size(); ++i) {
    const std::size_t k = coordinates_[static_cast<std::size_t>(i)];
    const Gene& gene = domain_.gene(k);
    double value = centre[k] + step[i] * widths_[i];
    if (value < gene.lower + kSnap * widths_[i]) value = gene.lower;
    if (value > gene.upper - kSnap * widths_[i]) value = gene.upper;
    free[k] = value;
  }
  return domain_.pull_inside(free, centre);
}

bool LocalSpace::same_rest(const Genes& a, const Genes& b) const {
  for (std::size_t k = 0; k < is_rest_.size(); ++k) {
    if (is_rest_[k] && a[k] != b[k]) return false;
  }
  return true;
}

std::optional<LocalPoint> LocalSpace::point(const Genes& free, const Evaluation& evaluation) const {
  if (!evaluation.evaluated_ok) return std::nullopt;
  Vector responses(1 + static_cast<Eigen::Index>(constraints_.size()));
  responses[0] = evaluation.objective;
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    responses[static_cast<Eigen::Index>(c) + 1] =
        single_ ? evaluation.violation : evaluation.constraints[c];
  }
  responses.tail(scales_.size()).array() /= scales_.array();
  if (!responses.allFinite()) return std::nullopt;
  const double worst = violation(responses);
  return LocalPoint{free, position(free), std::move(responses), worst};
}

double LocalSpace::violation(const Vector& responses) const {
  double worst = -HUGE_VAL;
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    worst = std::max(worst, constraints_[c].violation(responses[static_cast<Eigen::Index>(c) + 1]));
  }
  return worst;
}

bool LocalSpace::nears_a_failure(const Genes& centre, const Genes& free) const {
  const Vector step = position(free) - position(centre);
  return std::ranges::any_of(ways_to_failures(centre, HUGE_VAL), [&](const Vector& way) {
    return way.dot(step) > 0.5 * way.squaredNorm();
  });
}

// To those that a step within `radius` may come near to, nearest first.
std::vector<Vector> LocalSpace::ways_to_failures(const Genes& centre, double radius) const {
  const Vector at = position(centre);
  std::vector<Vector> ways;
  for (const Genes& failure : failed_) {
    if (!same_rest(failure, centre)) continue;
    const Vector way = position(failure) - at;
    if (way.squaredNorm() > 0 && way.cwiseAbs().maxCoeff() <= 2 * radius) ways.push_back(way);
  }
  std::ranges::stable_sort(ways, {}, [](const Vector& way) { return way.squaredNorm(); });
  return ways;
}

void LocalSpace::linear_rows(const Genes& centre, double radius, Matrix& rows,
                             Vector& bounds) const {
  const Eigen::Index n = size();
  const auto& given = domain_.rows();
  const Vector at = position(centre);
  std::vector<Vector> ways = ways_to_failures(centre, radius);
  ways.resize(std::min(ways.size(), static_cast<std::size_t>(2 * n)));
  const auto linear = static_cast<Eigen::Index>(given.size() + ways.size());
  rows = Matrix::Zero(linear + 2 * n, n);
  bounds.resize(linear + 2 * n);
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const auto r = static_cast<Eigen::Index>(given.size() + w);
    rows.row(r) = ways[w].normalized().transpose();
    bounds[r] = 0.5 * ways[w].norm();
  }
  for (Eigen::Index r = 0; r < static_cast<Eigen::Index>(given.size()); ++r) {
    const auto& row = given[static_cast<std::size_t>(r)];
    double left = row.bound;
    for (std::size_t k = 0; k < centre.size(); ++k) left -= row.weights[k] * centre[k];
    for (Eigen::Index i = 0; i < n; ++i) {
      rows(r, i) = row.weights[coordinates_[static_cast<std::size_t>(i)]] * widths_[i];
    }
    const double length = rows.row(r).norm();
    if (length > 0) rows.row(r) /= length;
    bounds[r] = std::max(left, 0.0) / (length > 0 ? length : 1);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    rows(linear + 2 * i, i) = 1;
    bounds[linear + 2 * i] = std::min(radius, 1 - at[i]);
    rows(linear + 2 * i + 1, i) = -1;
    bounds[linear + 2 * i + 1] = std::min(radius, at[i]);
  }
}

Vector LocalModel::at(const Vector& step) const {
  Vector result = values + gradients.transpose() * step;
  for (std::size_t r = 0; r < hessians.size(); ++r) {
    result[static_cast<Eigen::Index>(r)] += 0.5 * step.dot(hessians[r] * step);
  }
  return result;
}

Vector LocalModel::gradient(std::size_t response, const Vector& step) const {
  Vector result = gradients.col(static_cast<Eigen::Index>(response));
  if (!hessians.empty()) result += hessians[response] * step;
  return result;
}

LocalModel fit_linear(const Matrix& steps, const Matrix& values, const Vector& centre_values,
                      const Vector& weights) {
  constexpr double kRidge = 1e-12;
  const double scale = std::max(steps.cwiseAbs().maxCoeff(), 1e-300);
  const Matrix scaled = steps / scale;
  Matrix normal = scaled.transpose() * weights.asDiagonal() * scaled;
  normal.diagonal().array() += kRidge * std::max(normal.trace(), 1e-300);
  const Matrix rest = values.rowwise() - centre_values.transpose();
  const Matrix solution = normal.ldlt().solve(scaled.transpose() * weights.asDiagonal() * rest);
  return {centre_values, solution / scale, {}};
}

LocalModel fit_quadratic(const Matrix& steps, const Matrix& values, const Vector& centre_values,
                         const std::vector<Matrix>& earlier) {
  constexpr double kRidge = 1e-12;
  const Eigen::Index points = steps.rows();
  const Eigen::Index n = steps.cols();
  const double scale = std::max(steps.rowwise().norm().maxCoeff(), 1e-300);
  const Matrix scaled = steps / scale;
  Matrix system = Matrix::Zero(points + n, points + n);
  system.topLeftCorner(points, points) =
      0.5 * (scaled * scaled.transpose()).array().square().matrix();
  system.topLeftCorner(points, points).diagonal().array() += kRidge;
  system.topRightCorner(points, n) = scaled;
  system.bottomLeftCorner(n, points) = scaled.transpose();
  system.bottomRightCorner(n, n).diagonal().array() -= kRidge;
  Matrix right = Matrix::Zero(points + n, values.cols());
  right.topRows(points) = values.rowwise() - centre_values.transpose();
  for (std::size_t r = 0; r < earlier.size(); ++r) {
    for (Eigen::Index i = 0; i < points; ++i) {
      const Vector step = steps.row(i).transpose();
      right(i, static_cast<Eigen::Index>(r)) -= 0.5 * step.dot(earlier[r] * step);
    }
  }
  const Eigen::PartialPivLU<Matrix> factor(system);
  Matrix solution = factor.solve(right);
  solution += factor.solve(right - system * solution);
  LocalModel model{centre_values, solution.bottomRows(n) / scale, {}};
  for (Eigen::Index r = 0; r < values.cols(); ++r) {
    const Vector weights = solution.col(r).head(points);
    Matrix hessian = scaled.transpose() * weights.asDiagonal() * scaled / (scale * scale);
    if (!earlier.empty()) hessian += earlier[static_cast<std::size_t>(r)];
    model.hessians.push_back(std::move(hessian));
  }
  return model;
}

namespace {

// The linear part of the programs around a centre, in units of the radius, so that the solver's
// tolerances are relative to it. The first rows are left free for the nonlinear constraints.
ConvexProgram linear_part(const LocalSpace& space, const Genes& centre, double radius) {
  Matrix linear_rows;
  Vector linear_bounds;
  space.linear_rows(centre, radius, linear_rows, linear_bounds);
  linear_bounds /= radius;
  constexpr double kInside = 1e-9;  // so that rounding cannot move a step out of the linear domain
  linear_bounds.head(linear_bounds.size() - 2 * space.size()).array() -= kInside;
  ConvexProgram program;
  program.elastic = static_cast<Eigen::Index>(row_count(space.constraints()));
  program.rows.resize(program.elastic + linear_rows.rows(), space.size());
  program.bounds.resize(program.elastic + linear_rows.rows());
  program.rows.bottomRows(linear_rows.rows()) = linear_rows;
  program.bounds.tail(linear_rows.rows()) = linear_bounds;
  return program;
}

// Writes the model at `at` into a convex program: the nonlinear rows and the objective. The
// objective's curvature is that of the Lagrangian with these multipliers.
void linearize(const LocalModel& model, const std::vector<NonlinearConstraint>& constraints,
               const Vector& at, const Vector& multipliers, double radius, ConvexProgram& program) {
  const Vector responses = model.at(at);
  const bool curved = !model.hessians.empty();
  Matrix curvature = Matrix::Zero(at.size(), at.size());
  if (curved) curvature = model.hessians[0];
  Eigen::Index r = 0;
  const auto add_row = [&](double sign, std::size_t c, double tolerance) {
    const auto response = static_cast<Eigen::Index>(c) + 1;
    const Vector gradient = sign * model.gradient(c + 1, at);
    // The tolerance of an equality may be scaled below the margin.
    const double margin = tolerance > 0 ? std::min(kMargin, tolerance / 2) : kMargin;
    program.rows.row(r) = gradient.transpose() * radius;
    program.bounds[r] = tolerance - margin - sign * responses[response] + gradient.dot(at);
    if (curved) curvature += sign * multipliers[r] * model.hessians[c + 1];
    ++r;
  };
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    add_row(1, c, constraints[c].tolerance);
    if (constraints[c].relation == Relation::kEqual) add_row(-1, c, constraints[c].tolerance);
  }
  program.hessian = curved ? convex(curvature) : curvature;
  program.gradient = (model.gradient(0, at) - program.hessian * at) * radius;
  program.hessian *= radius * radius;
}

// A penalty well above the ratio that the steepest constraint needs.
double first_penalty(const ConvexProgram& program) {
  const double steepest = program.gradient.cwiseAbs().maxCoeff();
  const double rise = program.rows.topRows(program.elastic).rowwise().norm().maxCoeff();
  return rise > 0 ? 10 * steepest / rise : 1;
}

// Raises the penalty until the solution has most of the feasibility that is possible. `violation`
// is that before the step.
ConvexSolution solve_steered(ConvexProgram& program, double violation, double& penalty) {
  program.penalty = penalty;
  ConvexSolution solution = solve(program);
  if (!solution.converged || !(solution.excess > kMargin)) return solution;
  ConvexProgram feasibility = program;
  feasibility.hessian.setZero();
  feasibility.gradient.setZero();
  feasibility.penalty = 1;
  const double least = solve(feasibility).excess;
  for (int raise = 0; raise < 6; ++raise) {
    constexpr double kSolved = 1e-7;  // below it the solver's own tolerance would decide
    if (solution.excess - least <= 0.1 * (violation - least) + kSolved * (1 + violation)) break;
    penalty *= 10;
    program.penalty = penalty;
    solution = solve(program);
  }
  return solution;
}

}  // namespace

LocalStep best_step(const LocalSpace& space, const Genes& centre, const LocalModel& model,
                    double radius, double& penalty) {
  const auto merit = [&](const Vector& responses) {
    return responses[0] + penalty * std::max(0.0, space.violation(responses) + kMargin);
  };
  ConvexProgram program = linear_part(space, centre, radius);
  LocalStep best{Vector::Zero(space.size())};
  Vector at = Vector::Zero(space.size());
  Vector multipliers = Vector::Zero(program.elastic);
  const int passes = model.hessians.empty() ? 1 : 5;
  for (int pass = 0; pass < passes; ++pass) {
    linearize(model, space.constraints(), at, multipliers, radius, program);
    if (penalty == 0) penalty = first_penalty(program);
    const double violation = std::max(0.0, space.violation(model.at(at)));
    const ConvexSolution solution = solve_steered(program, violation, penalty);
    multipliers = solution.multipliers.head(program.elastic);
    if (!solution.x.allFinite()) break;
    const double sum = multipliers.sum();
    if (sum < 0.9 * penalty) penalty = std::max(penalty, 2 * sum);
    const Vector next = solution.x * radius;
    const double reduction = merit(model.values) - merit(model.at(next));
    if (pass == 0 || reduction > best.reduction) best = {next, reduction, sum};
    if ((next - at).cwiseAbs().maxCoeff() < 1e-6 * radius) break;
    at = next;
  }
  best.reduction = merit(model.values) - merit(model.at(best.step));
  return best;
}

}  // namespace emax
