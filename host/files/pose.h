#pragma once

#include <Eigen/Core>
#include <array>

#include "sw_model/base/mesh_view.h"

namespace emax {

// The place and direction of a scanner: a rotation about the origin, then a shift. For the parts of
// GLB and 3MF files the matrix may be any.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Point shift = Point::Zero();

  // Each coordinate is ((r0 x + r1 y) + r2 z) + shift, with a rounding for each operation.
  Point operator()(const Point& p) const {
    Point moved;
    for (int k = 0; k < 3; ++k) {
      moved[k] = rotation(k, 0) * p[0] + rotation(k, 1) * p[1] + rotation(k, 2) * p[2] + shift[k];
    }
    return moved;
  }

  // How far the matrix is from a rotation: the greatest element of its product with its own
  // transpose less the identity, infinite for a reflection and where a number is not finite. It
  // changes lengths by about half of this share.
  double defect() const;
};

// First `inner`, then `outer`.
inline Pose operator*(const Pose& outer, const Pose& inner) {
  return {outer.rotation * inner.rotation, outer(inner.shift)};
}

// A pose with a greater defect is refused. Files of six digits stay below.
inline constexpr double kGreatestDefect = 1e-5;

// The rotation of a quaternion w, x, y, z whose length is not 0.
Eigen::Matrix3d rotation_of(const std::array<double, 4>& quaternion);

}  // namespace emax
