#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "host/features/shapes.h"

namespace emax {

// Sums over points, from which the plane of least squares follows at any time in O(1). Its points
// should lie around the origin: a variance loses 2^-52 of the greatest squared coordinate.
class PlaneSums {
 public:
  void add(const Point& p) {
    ++count_;
    sum_ += p;
    products_.noalias() += p * p.transpose();
  }
  std::size_t count() const { return count_; }
  // At least one point.
  Plane plane() const;

 private:
  std::size_t count_ = 0;
  Point sum_ = Point::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
};

// A plane through points, and how well they tell it.
struct FittedPlane {
  Plane plane;
  Point centre = Point::Zero();  // of the points, on the plane
  Point along, across;           // unit, in the plane: where the points spread most, and least
  double length = 0, width = 0;  // their standard deviations along these
  double rms = 0;                // of the distances
};

// The plane of least squares of the squared distances (Pearson 1901): its normal is the eigenvector
// of the covariance with the least eigenvalue. `members` are numbers of points, at least one. O(n).
FittedPlane fit_plane(std::span<const Point> points, std::span<const std::uint32_t> members);

// The same of those points that lie within three deviations of `first`, the deviation estimated
// from the median of the distances (1.4826 of it, as of a normal distribution): points of other
// surfaces that the plane cuts tilt it less. Two rounds. O(n).
FittedPlane fit_plane_robustly(std::span<const Point> points,
                               std::span<const std::uint32_t> members, const Plane& first);

// By how many radians a surface turns from one end to the other, where it turns most.
struct Turning {
  double angle = 0;
  double error = 0;  // its standard error
};

// A quadric is fitted over the plane, whose second derivative along the longer or the shorter
// direction of the points counts over their length there. Small for a plane and for one that bows a
// little, large for a strip of a cylinder, however narrow the band is in which both are searched.
// Zeros for fewer than seven points. O(n).
Turning turning(std::span<const Point> points, std::span<const std::uint32_t> members,
                const FittedPlane& plane);

}  // namespace emax
