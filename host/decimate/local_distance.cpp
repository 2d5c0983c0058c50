#include "host/decimate/local_distance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/decimate/local_distance.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Products and sums are rounded apart, so that every target gives the same bits.
void measure(LocalPoints& points, std::span<const LocalFrame> triangles) {
  const hn::ScalableTag<double> tag;
  using Lanes = hn::Vec<decltype(tag)>;
  const auto all = [&](double value) HWY_ATTR { return hn::Set(tag, value); };
  const Lanes zero = hn::Zero(tag);
  for (std::size_t i = 0; i < points.count; i += hn::Lanes(tag)) {
    const Lanes px = hn::LoadU(tag, &points.x[i]);
    const Lanes py = hn::LoadU(tag, &points.y[i]);
    const Lanes pz = hn::LoadU(tag, &points.z[i]);
    Lanes best = all(1e300);
    Lanes which = zero;
    double index = 0;
    for (const LocalFrame& t : triangles) {
      const Lanes qx = hn::Sub(px, all(t.origin[0]));
      const Lanes qy = hn::Sub(py, all(t.origin[1]));
      const Lanes qz = hn::Sub(pz, all(t.origin[2]));
      const auto dot = [&](const Point& axis) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(qx, all(axis[0])), hn::Mul(qy, all(axis[1]))),
                       hn::Mul(qz, all(axis[2])));
      };
      const Lanes x = dot(t.normal), y = dot(t.in_plane), z = dot(t.along);
      const Lanes zl = hn::Sub(z, all(t.length));
      Lanes planar = all(1e300);
      hn::Mask<decltype(tag)> outside = hn::Lt(y, zero);
      const auto edge = [&](Lanes across, Lanes s, Lanes beyond) HWY_ATTR {
        const auto visible = hn::Lt(across, zero);
        const Lanes r = hn::IfThenElse(hn::Lt(s, zero), s, hn::Max(beyond, zero));
        const Lanes squared = hn::Add(hn::Mul(across, across), hn::Mul(r, r));
        planar = hn::IfThenElse(visible, hn::Min(planar, squared), planar);
        outside = hn::Or(outside, visible);
      };
      edge(y, z, zl);
      const Lanes s2 = hn::Add(hn::Mul(y, all(t.y13)), hn::Mul(z, all(t.z13)));
      edge(hn::Sub(hn::Mul(z, all(t.y13)), hn::Mul(y, all(t.z13))), s2,
           hn::Sub(s2, all(t.length13)));
      const Lanes s3 = hn::Add(hn::Mul(y, all(t.y23)), hn::Mul(zl, all(t.z23)));
      edge(hn::Sub(hn::Mul(y, all(t.z23)), hn::Mul(zl, all(t.y23))), s3,
           hn::Sub(s3, all(t.length23)));
      const Lanes squared = hn::Add(hn::Mul(x, x), hn::IfThenElse(outside, planar, zero));
      const auto nearer = hn::Lt(squared, best);
      best = hn::IfThenElse(nearer, squared, best);
      which = hn::IfThenElse(nearer, all(index), which);
      index += 1;
    }
    hn::StoreU(best, tag, &points.squared[i]);
    hn::StoreU(which, tag, &points.nearest[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace emax {

HWY_EXPORT(measure);

void measure(LocalPoints& points, std::span<const LocalFrame> triangles) {
  HWY_DYNAMIC_DISPATCH(measure)(points, triangles);
}

void LocalPoints::push_back(const Point& p) {
  constexpr std::size_t kLongestVector = 64;
  if (count + kLongestVector > x.size()) {
    for (std::vector<double>* array : {&x, &y, &z, &squared, &nearest}) {
      array->resize(2 * count + 4 * kLongestVector, 0.0);
    }
  }
  x[count] = p[0];
  y[count] = p[1];
  z[count] = p[2];
  ++count;
}

LocalFrame local_frame(const std::array<Point, 3>& corners) {
  const Point u = corners[1] - corners[0];
  const Point w = corners[2] - corners[0];
  LocalFrame f;
  f.origin = corners[0];
  f.length = u.norm();
  f.along = u / f.length;
  f.normal = u.cross(w).normalized();
  f.in_plane = f.normal.cross(f.along);
  const double y = f.in_plane.dot(w);
  const double z = f.along.dot(w);
  f.length13 = std::sqrt(y * y + z * z);
  f.y13 = y / f.length13;
  f.z13 = z / f.length13;
  const double zl = z - f.length;
  f.length23 = std::sqrt(y * y + zl * zl);
  f.y23 = y / f.length23;
  f.z23 = zl / f.length23;
  return f;
}

Foot foot_on(const LocalFrame& f, const Point& p) {
  const Point q = p - f.origin;
  const double x = f.normal.dot(q), y = f.in_plane.dot(q), z = f.along.dot(q);
  const double zl = z - f.length;
  const double s2 = y * f.y13 + z * f.z13;
  const double s3 = y * f.y23 + zl * f.z23;
  const double h2 = z * f.y13 - y * f.z13;
  const double h3 = y * f.z23 - zl * f.y23;
  // The height of the first corner over edge 2-3, as h3 measures it.
  const double height = f.length * f.y23;
  double foot_y = y, foot_z = z, best = 1e300;
  const auto edge = [&](double across, double s, double length, double from_z, double dy,
                        double dz) {
    if (across >= 0) return;
    const double at = std::clamp(s, 0.0, length);
    const double squared = across * across + (s - at) * (s - at);
    if (squared >= best) return;
    best = squared;
    foot_y = at * dy;
    foot_z = from_z + at * dz;
  };
  edge(y, z, f.length, 0, 0, 1);
  edge(h2, s2, f.length13, 0, f.y13, f.z13);
  edge(h3, s3, f.length23, f.length, f.y23, f.z23);
  Foot foot;
  foot.residual = x * f.normal + (y - foot_y) * f.in_plane + (z - foot_z) * f.along;
  const double at_foot = foot_y * f.z23 - (foot_z - f.length) * f.y23;
  foot.weight = std::clamp(at_foot / height, 0.0, 1.0);
  const double distance = foot.residual.norm();
  foot.direction = best < 1e300 && distance > 0 ? Point(foot.residual / distance) : f.normal;
  return foot;
}

}  // namespace emax

#endif
