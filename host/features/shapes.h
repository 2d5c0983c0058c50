#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <variant>

#include "sw_model/base/mesh_view.h"

namespace emax {

// The points p with normal . p = offset.
struct Plane {
  Point normal = Point::UnitZ();  // unit; its greatest coordinate is positive
  double offset = 0;

  double signed_distance(const Point& p) const { return normal.dot(p) - offset; }
  Point normal_at(const Point&) const { return normal; }
};

// The points at `radius` from a line.
struct Cylinder {
  Point centre = Point::Zero();  // on the axis, amid the points that the cylinder was found from
  Point axis = Point::UnitZ();   // unit; its greatest coordinate is positive
  double radius = 0;

  // From the axis, at a right angle to it.
  Point outward(const Point& p) const {
    const Point from = p - centre;
    return from - axis.dot(from) * axis;
  }
  double signed_distance(const Point& p) const { return outward(p).norm() - radius; }
  Point normal_at(const Point& p) const { return outward(p).normalized(); }
};

// The points at `radius` from `centre`.
struct Sphere {
  Point centre = Point::Zero();
  double radius = 0;

  double signed_distance(const Point& p) const { return (p - centre).norm() - radius; }
  Point normal_at(const Point& p) const { return (p - centre).normalized(); }
};

using Shape = std::variant<Plane, Cylinder, Sphere>;

inline double distance(const Shape& shape, const Point& p) {
  return std::visit([&](const auto& s) { return std::abs(s.signed_distance(p)); }, shape);
}

// `direction` or its opposite: the one whose greatest coordinate is positive.
inline Point canonical_sign(const Point& direction) {
  int greatest = 0;
  direction.cwiseAbs().maxCoeff(&greatest);
  return direction[greatest] < 0 ? Point(-direction) : direction;
}

}  // namespace emax
