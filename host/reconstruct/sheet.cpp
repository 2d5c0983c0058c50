#include "host/reconstruct/sheet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/reconstruct/delaunay.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {

Sheet::Sheet(std::span<const Point> points, const Region& region, double reach)
    : region_(&region),
      spacing_(std::sqrt(region.area / static_cast<double>(region.points.size()))),
      reach_(reach * spacing_),
      period_(0) {
  if (const auto* const plane = std::get_if<Plane>(&region.shape)) {
    origin_ = plane->offset * plane->normal;
    u_ = plane->normal.unitOrthogonal();
    v_ = plane->normal.cross(u_);
  } else {
    const Cylinder& cylinder = std::get<Cylinder>(region.shape);
    origin_ = cylinder.centre;
    u_ = cylinder.axis.unitOrthogonal();
    v_ = cylinder.axis.cross(u_);
    radius_ = cylinder.radius;
    period_ = 2 * std::numbers::pi * radius_;
    constexpr double kAlong = 6;
    along_ = kAlong * reach_;
    around_ = std::min(reach_, period_ / 6);
    reach_ = std::min(reach_, period_ / 4);
  }
  for (const std::uint32_t i : region.points) box_.extend(points[i]);
}

Eigen::Vector2d Sheet::flatten(const Point& p) const {
  const Point from = p - origin_;
  if (period_ == 0) return {u_.dot(from), v_.dot(from)};
  return {radius_ * std::atan2(v_.dot(from), u_.dot(from)), u_.cross(v_).dot(from)};
}

Point Sheet::raise(const Eigen::Vector2d& flat) const {
  if (period_ == 0) return origin_ + flat.x() * u_ + flat.y() * v_;
  const double angle = flat.x() / radius_;
  return origin_ + radius_ * (std::cos(angle) * u_ + std::sin(angle) * v_) +
         flat.y() * u_.cross(v_);
}

double Sheet::around(double offset) const {
  return period_ == 0 ? offset : std::remainder(offset, period_);
}

// Around a cylinder the places stand three times, and of the copies of a triangle the one counts
// whose least place is in the middle.
std::vector<Triangle> Sheet::triangulate(std::span<const Eigen::Vector2d> places) const {
  if (period_ == 0) return alpha_shape(places, reach_);
  const auto count = static_cast<std::uint32_t>(places.size());
  const double squeeze = EMAX_FAULT(kSpansAlikeAlongAxes) ? 1 : around_ / along_;
  std::vector<Eigen::Vector2d> unrolled;
  for (const int turn : {0, -1, 1}) {
    for (const Eigen::Vector2d& p : places) {
      unrolled.emplace_back(p.x() + turn * period_, squeeze * p.y());
    }
  }
  std::vector<Triangle> triangles;
  for (const Triangle& copy : alpha_shape(unrolled, around_)) {
    const Triangle t = {copy[0] % count, copy[1] % count, copy[2] % count};
    const auto least = static_cast<std::size_t>(std::ranges::min_element(t) - t.begin());
    if (copy[least] < count && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace emax
