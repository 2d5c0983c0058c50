#include "host/decimate/plane_place.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace emax {
namespace {

// The least eigenvalue of the sum of n n^T, for a direction in which the planes fix the place. Two
// planes at an angle have 1 - cos.
constexpr double kLeastEigenvalue = 0.01;

}  // namespace

std::optional<PlanePlace> place_on(std::span<const Plane> planes, const Point& near, double apart) {
  PlanePlace place;
  if (planes.size() == 1) {
    const Plane& plane = planes.front();
    place.at = near - plane.signed_distance(near) * plane.normal;
    place.along -= plane.normal * plane.normal.transpose();
    return place;
  }
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Point right = Point::Zero();
  for (const Plane& plane : planes) {
    matrix += plane.normal * plane.normal.transpose();
    right -= plane.signed_distance(near) * plane.normal;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  place.at = near;
  for (int i = 0; i < 3; ++i) {
    if (!(solver.eigenvalues()[i] > kLeastEigenvalue)) continue;
    const Point direction = solver.eigenvectors().col(i);
    place.at += direction.dot(right) / solver.eigenvalues()[i] * direction;
    place.along -= direction * direction.transpose();
  }
  for (const Plane& plane : planes) {
    if (!(std::abs(plane.signed_distance(place.at)) <= apart)) return std::nullopt;
  }
  return place;
}

}  // namespace emax
