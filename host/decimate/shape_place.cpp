#include "host/decimate/shape_place.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

// The least eigenvalue of the sum of n n^T, for a direction in which the shapes fix the place. Two
// planes at an angle have 1 - cos.
constexpr double kLeastEigenvalue = 0.01;
// Newton's steps between curved shapes double the digits; what takes longer finds no place.
constexpr int kMostSteps = 20;
constexpr double kStill = 1e-9;  // of `apart`: a step that ends them

struct Tangent {
  double distance;  // signed
  Point normal;
};

Tangent tangent_at(const Shape& shape, const Point& p) {
  return std::visit(
      [&](const auto& s) {
        return Tangent{s.signed_distance(p), s.normal_at(p)};
      },
      shape);
}

struct Step {
  Point to = Point::Zero();
  Eigen::Matrix3d along = Eigen::Matrix3d::Identity();
};

// The shortest way to the place of the planes that touch the shapes beside p.
Step step_from(const Point& p, std::span<const Shape> shapes) {
  Step step;
  if (shapes.size() == 1) {
    const auto [distance, normal] = tangent_at(shapes.front(), p);
    step.to = p - distance * normal;
    step.along -= normal * normal.transpose();
    return step;
  }
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Point right = Point::Zero();
  for (const Shape& shape : shapes) {
    const auto [distance, normal] = tangent_at(shape, p);
    matrix += normal * normal.transpose();
    right -= distance * normal;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  step.to = p;
  for (int i = 0; i < 3; ++i) {
    if (!(solver.eigenvalues()[i] > kLeastEigenvalue)) continue;
    const Point direction = solver.eigenvectors().col(i);
    step.to += direction.dot(right) / solver.eigenvalues()[i] * direction;
    step.along -= direction * direction.transpose();
  }
  return step;
}

// Whether all shapes pass so near; false for a point that is not finite.
bool all_near(std::span<const Shape> shapes, const Point& p, double apart) {
  return std::ranges::all_of(shapes, [&](const Shape& s) { return distance(s, p) <= apart; });
}

// One step reaches any number of planes, and a single shape.
std::optional<Point> reach(const Point& from, std::span<const Shape> shapes, double apart) {
  Point at = from;
  for (int i = 0; i < kMostSteps; ++i) {
    const Point next = step_from(at, shapes).to;
    const bool still = (next - at).norm() <= kStill * apart;
    at = next;
    if (still || shapes.size() == 1 || EMAX_FAULT(kTakesTangents)) {
      return all_near(shapes, at, apart) ? std::optional(at) : std::nullopt;
    }
  }
  return std::nullopt;
}

bool is_curved(const Shape& shape) { return !std::holds_alternative<Plane>(shape); }

}  // namespace

Point ShapePlace::project(const Point& p) const {
  if (shapes_.empty()) return at_ + along_ * (p - at_);
  return reach(p, shapes_, apart_).value_or(at_);
}

Eigen::Matrix3d ShapePlace::along(const Point& p) const {
  return shapes_.empty() ? along_ : step_from(p, shapes_).along;
}

std::optional<ShapePlace> place_on(std::span<const Shape> shapes, const Point& near, double apart) {
  ShapePlace place;
  place.apart_ = apart;
  if (std::ranges::any_of(shapes, is_curved)) {
    const std::optional<Point> at = reach(near, shapes, apart);
    if (!at) return std::nullopt;
    place.at_ = *at;
    place.shapes_.assign(shapes.begin(), shapes.end());
    return place;
  }
  const Step step = step_from(near, shapes);
  if (!all_near(shapes, step.to, apart)) return std::nullopt;
  place.at_ = step.to;
  place.along_ = step.along;
  return place;
}

}  // namespace emax
