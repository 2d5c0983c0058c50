#include "host/features/curved_fit.h"

#include <Eigen/Dense>
#include <cmath>

namespace emax {
namespace {

constexpr double kLeastSine = 0.1;  // of the angle between two normals
constexpr int kFitSteps = 12;
constexpr double kConverged = 1e-12;    // of the radius, that a step moves by
constexpr double kGreatestGrowth = 10;  // of the radius, from the first shape's

struct Approach {
  Point on_a, on_b;         // where the lines are nearest to each other
  double along_a, along_b;  // how far from the points
};

// Of the lines a + s u and b + t v; nothing where they are nearly parallel.
std::optional<Approach> nearest_approach(const Point& a, const Point& u, const Point& b,
                                         const Point& v) {
  const double cosine = u.dot(v), squared_sine = 1 - cosine * cosine;
  if (!(squared_sine > kLeastSine * kLeastSine)) return std::nullopt;
  const Point d = b - a;
  const double s = (d.dot(u) - cosine * d.dot(v)) / squared_sine;
  const double t = (cosine * d.dot(u) - d.dot(v)) / squared_sine;
  return Approach{a + s * u, b + t * v, s, t};
}

template <int kParameters>
class NormalEquations {
 public:
  using Row = Eigen::Matrix<double, kParameters, 1>;
  void add(const Row& derivatives, double residual) {
    matrix_.noalias() += derivatives * derivatives.transpose();
    right_ -= residual * derivatives;
  }
  Row step() const { return matrix_.ldlt().solve(right_); }

 private:
  Eigen::Matrix<double, kParameters, kParameters> matrix_ =
      Eigen::Matrix<double, kParameters, kParameters>::Zero();
  Row right_ = Row::Zero();
};

bool is_sound(double radius, double first) {
  return std::isfinite(radius) && radius > 0 && radius < kGreatestGrowth * first;
}

}  // namespace

std::optional<Cylinder> cylinder_through(const Point& a, const Point& normal_a, const Point& b,
                                         const Point& normal_b, double band) {
  const Point across = normal_a.cross(normal_b);
  if (!(across.norm() > kLeastSine)) return std::nullopt;
  const Point axis = canonical_sign(across.normalized());
  // In the plane through a at a right angle to the axis.
  const Point b_there = b - axis.dot(b - a) * axis;
  const auto meeting = nearest_approach(a, normal_a, b_there, normal_b);
  if (!meeting) return std::nullopt;
  const double radius_a = std::abs(meeting->along_a), radius_b = std::abs(meeting->along_b);
  if (std::abs(radius_a - radius_b) > band) return std::nullopt;
  const double along = axis.dot(b - a) / 2;
  return Cylinder{meeting->on_a + along * axis, axis, (radius_a + radius_b) / 2};
}

std::optional<Sphere> sphere_through(const Point& a, const Point& normal_a, const Point& b,
                                     const Point& normal_b, double band) {
  const auto meeting = nearest_approach(a, normal_a, b, normal_b);
  if (!meeting || (meeting->on_a - meeting->on_b).norm() > band) return std::nullopt;
  const Point centre = (meeting->on_a + meeting->on_b) / 2;
  const double radius_a = (a - centre).norm(), radius_b = (b - centre).norm();
  if (std::abs(radius_a - radius_b) > band) return std::nullopt;
  return Sphere{centre, (radius_a + radius_b) / 2};
}

std::optional<Cylinder> fit_cylinder(std::span<const Point> points,
                                     std::span<const std::uint32_t> members, Cylinder first) {
  Cylinder cylinder = first;
  for (int i = 0; i < kFitSteps; ++i) {
    const Point u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
    NormalEquations<5> equations;  // the centre along u and v, the axis towards them, the radius
    for (const std::uint32_t m : members) {
      const Point outward = cylinder.outward(points[m]);
      const double distance = outward.norm();
      if (!(distance > 0)) continue;
      const double along = cylinder.axis.dot(points[m] - cylinder.centre) / cylinder.radius;
      const double x = u.dot(outward) / distance, y = v.dot(outward) / distance;
      equations.add({-x, -y, -along * x, -along * y, -1}, distance - cylinder.radius);
    }
    const auto step = equations.step();
    cylinder.axis += (step[2] * u + step[3] * v) / cylinder.radius;
    cylinder.axis.normalize();
    cylinder.centre += step[0] * u + step[1] * v;
    cylinder.radius += step[4];
    if (!is_sound(cylinder.radius, first.radius)) return std::nullopt;
    if (step.norm() <= kConverged * cylinder.radius) break;
  }
  Point sum = Point::Zero();
  for (const std::uint32_t m : members) sum += points[m];
  const Point mean = sum / static_cast<double>(members.size());
  cylinder.centre += cylinder.axis.dot(mean - cylinder.centre) * cylinder.axis;
  cylinder.axis = canonical_sign(cylinder.axis);
  return cylinder;
}

std::optional<Sphere> fit_sphere(std::span<const Point> points,
                                 std::span<const std::uint32_t> members, Sphere first) {
  Sphere sphere = first;
  for (int i = 0; i < kFitSteps; ++i) {
    NormalEquations<4> equations;
    for (const std::uint32_t m : members) {
      const Point outward = points[m] - sphere.centre;
      const double distance = outward.norm();
      if (!(distance > 0)) continue;
      const Point unit = outward / distance;
      equations.add({-unit[0], -unit[1], -unit[2], -1}, distance - sphere.radius);
    }
    const auto step = equations.step();
    sphere.centre += step.head<3>();
    sphere.radius += step[3];
    if (!is_sound(sphere.radius, first.radius)) return std::nullopt;
    if (step.norm() <= kConverged * sphere.radius) break;
  }
  return sphere;
}

}  // namespace emax
