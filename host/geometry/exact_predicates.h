#pragma once

#include <Eigen/Core>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Exact for all finite input. A floating-point filter decides where rounding cannot change the
// sign; integers of as many bits as needed decide the other cases. 10 ns where the filter decides,
// about 50 ns where the coordinates along each axis span at most 60 bits, else a microsecond or
// more.

// The sign (-1, 0, 1) of the signed area of (a, b, c): 1 when they turn counter-clockwise.
int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

// The sign of ((b - a) x (c - a)) . (d - a): 1 when d is on the side to which the normal of (a, b,
// c) points, 0 when the four are coplanar.
int orient3d(const Point& a, const Point& b, const Point& c, const Point& d);

// Whether the triangle has exactly no area.
bool collinear(const Point& a, const Point& b, const Point& c);

// The two coordinates other than `axis`, in cyclic order: seen against the axis, a
// counter-clockwise turn stays counter-clockwise.
inline Eigen::Vector2d project(const Point& point, int axis) {
  return {point[(axis + 1) % 3], point[(axis + 2) % 3]};
}

}  // namespace emax
