#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "host/features/shapes.h"

namespace emax {

// Where a vertex may lie so that it is on the shapes around it: on one of them, on the line where
// two meet, at the corner of three.
class ShapePlace {
 public:
  // The point of the place beside p, without one the one that place_on() found. O(1).
  Point project(const Point& p) const;
  // Projects onto the directions of the place at p, which is on it.
  Eigen::Matrix3d along(const Point& p) const;

 private:
  friend std::optional<ShapePlace> place_on(std::span<const Shape>, const Point&, double);
  Point at_ = Point::Zero();                             // a point of it
  Eigen::Matrix3d along_ = Eigen::Matrix3d::Identity();  // there
  std::vector<Shape> shapes_;                            // only where one of them is curved
  double apart_ = 0;
};

// The place of the shapes, seen from `near`. Shapes that meet at less than about eight degrees
// count as one, in the middle between them. Nothing where a shape passes farther than `apart` from
// the place: planes that are parallel, or more than three that do not share a point; nothing, too,
// where Newton's steps find no place of curved ones. At least one shape.
std::optional<ShapePlace> place_on(std::span<const Shape> shapes, const Point& near, double apart);

}  // namespace emax
