#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "host/features/shapes.h"

namespace emax {

// Where a vertex may lie so that the planes around it stay flat: on one plane, on the line of two,
// at the corner of three.
struct PlanePlace {
  Point at = Point::Zero();                             // a point of it
  Eigen::Matrix3d along = Eigen::Matrix3d::Identity();  // projects onto its directions
  Point project(const Point& p) const { return at + along * (p - at); }
};

// The place of the planes, seen from `near`. Planes that meet at less than about eight degrees
// count as one, in the middle between them. Nothing where a plane passes farther than `apart` from
// the place: planes that are parallel, or more than three that do not share a point. At least one
// plane.
std::optional<PlanePlace> place_on(std::span<const Plane> planes, const Point& near, double apart);

}  // namespace emax
