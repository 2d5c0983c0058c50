#include "host/features/plane_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace emax {
namespace {

constexpr double kDeviationsOfFit = 3, kMadOfNormal = 1.4826;
constexpr int kRoundsOfFit = 2;

double median_distance(std::span<const Point> points, std::span<const std::uint32_t> members,
                       const Plane& plane) {
  std::vector<double> distances;
  distances.reserve(members.size());
  for (const std::uint32_t i : members) {
    distances.push_back(std::abs(plane.signed_distance(points[i])));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

Plane PlaneSums::plane() const {
  const double n = static_cast<double>(count_);
  const Point mean = sum_ / n;
  const Eigen::Matrix3d covariance = products_ / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(covariance);
  const Point normal = canonical_sign(axes.eigenvectors().col(0));
  return {normal, normal.dot(mean)};
}

FittedPlane fit_plane(std::span<const Point> points, std::span<const std::uint32_t> members) {
  const double n = static_cast<double>(members.size());
  Point sum = Point::Zero();
  for (const std::uint32_t i : members) sum += points[i];
  FittedPlane fitted;
  fitted.centre = sum / n;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : members) {
    const Point d = points[i] - fitted.centre;
    covariance.noalias() += d * d.transpose() / n;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const auto deviation = [&](int i) { return std::sqrt(std::max(axes.eigenvalues()[i], 0.0)); };
  const Point normal = canonical_sign(axes.eigenvectors().col(0));
  fitted.plane = {normal, normal.dot(fitted.centre)};
  fitted.along = canonical_sign(axes.eigenvectors().col(2));
  fitted.across = normal.cross(fitted.along);
  fitted.length = deviation(2);
  fitted.width = deviation(1);
  fitted.rms = deviation(0);
  return fitted;
}

FittedPlane fit_plane_robustly(std::span<const Point> points,
                               std::span<const std::uint32_t> members, const Plane& first) {
  Plane plane = first;
  std::vector<std::uint32_t> near;
  for (int round = 0; round < kRoundsOfFit; ++round) {
    const double reach = kDeviationsOfFit * kMadOfNormal * median_distance(points, members, plane);
    near.clear();
    for (const std::uint32_t i : members) {
      if (std::abs(plane.signed_distance(points[i])) <= reach) near.push_back(i);
    }
    plane = fit_plane(points, near).plane;
  }
  return fit_plane(points, near);
}

Turning turning(std::span<const Point> points, std::span<const std::uint32_t> members,
                const FittedPlane& fitted) {
  constexpr int kTerms = 6;
  if (members.size() <= kTerms || !(fitted.width > 0)) return {};
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Terms right = Terms::Zero();
  double squares = 0;
  for (const std::uint32_t i : members) {
    const Point d = points[i] - fitted.centre;
    const double x = fitted.along.dot(d) / fitted.length, y = fitted.across.dot(d) / fitted.width;
    const double height = fitted.plane.signed_distance(points[i]);
    const Terms terms = {1, x, y, x * x, x * y, y * y};
    normal.noalias() += terms * terms.transpose();
    right += height * terms;
    squares += height * height;
  }
  const Eigen::LDLT<Eigen::Matrix<double, kTerms, kTerms>> solver(normal);
  const Terms fit = solver.solve(right);
  const double freedom = static_cast<double>(members.size() - kTerms);
  const double variance = std::max(squares - fit.dot(right), 0.0) / freedom;
  // The surface turns by the second derivative times the length; a uniform spread reaches sqrt(3)
  // deviations to both sides.
  const double ends = 2 * std::sqrt(3.0);
  Turning most;
  for (const auto& [term, deviation] : {std::pair(3, fitted.length), std::pair(5, fitted.width)}) {
    const Terms column = solver.solve(Terms::Unit(term));
    const double factor = ends * 2 / deviation;
    const Turning turning = {factor * std::abs(fit[term]),
                             factor * std::sqrt(std::max(variance * column[term], 0.0))};
    // What may be curved with more certainty.
    if (turning.angle - turning.error > most.angle - most.error || most.error == 0) most = turning;
  }
  return most;
}

}  // namespace emax
