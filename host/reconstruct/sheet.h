#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "host/features/region.h"

namespace emax {

// A region of a plane or a cylinder, laid out flat. Lengths in the unit of the points.
class Sheet {
 public:
  // The points and the region must outlive it. The shape is no sphere, the area not zero.
  Sheet(std::span<const Point> points, const Region& region, double reach);

  const Shape& shape() const { return region_->shape; }
  std::span<const std::uint32_t> points() const { return region_->points; }
  const Eigen::AlignedBox3d& box() const { return box_; }  // of the points
  // The side of the square that each point would have if they were spread evenly.
  double spacing() const { return spacing_; }
  // Points no farther from each other than twice this are connected: a multiple of the spacing, but
  // at most a quarter of the way around a cylinder.
  double reach() const { return reach_; }
  // The way around a cylinder, after which flat places come again; 0: a plane.
  double period() const { return period_; }

  // Along `u` and `v` of a plane; around a cylinder, from -period() / 2 on, and along its axis.
  // Triangles that run anticlockwise there do so seen from where the normals point to.
  Eigen::Vector2d flatten(const Point& p) const;
  Point raise(const Eigen::Vector2d& flat) const;
  Point onto(const Point& p) const { return raise(flatten(p)); }
  // `offset` as it is from the nearest of the places that it stands for.
  double around(double offset) const;
  // The alpha shape of flat places, as wide as the reach; around a cylinder it closes. There, the
  // circle is an ellipse: six times as long along the axis as the reach is, as nothing turns that
  // way and a scanner's rows are far apart on it, and at most a sixth of the way around to either
  // side, so that the far side of a pipe stays open.
  std::vector<Triangle> triangulate(std::span<const Eigen::Vector2d> places) const;

 private:
  const Region* region_;
  Point origin_, u_, v_;
  double radius_ = 0;
  Eigen::AlignedBox3d box_;
  double spacing_, reach_, period_;
  double around_ = 0, along_ = 0;  // half the axes of a cylinder's ellipse
};

}  // namespace emax
