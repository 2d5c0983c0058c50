#include "host/decimate/local_distance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/decimate/local_distance.cpp"
#include <hwy/foreach_target.h>
// This must follow foreach_target.h.
#include "sw_model/simd/simd_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

// Like the kernel's distance except for the choice of the edge: of the edges that a point sees the
// one with the least square is taken, where the kernel takes the least residual. Except for
// roundings it is the same edge, at less cost here.
template <class Real>
HWY_INLINE Real squared_distance_of(const kernel::TriangleRecord<Real>& triangle,
                                    const kernel::Vector3<Real>& p) {
  const Real zero(0.0);
  const kernel::Vector3<Real> at = kernel::to_frame(triangle, p);
  const kernel::TriangleView<Real> view = kernel::view_edges(triangle, at.y, at.z);
  Real least(1e300);
  auto outside = view.edge12.across < zero;
  for (const kernel::EdgeView<Real>& edge : {view.edge12, view.edge13, view.edge23}) {
    const auto visible = edge.across < zero;
    const Real squared = edge.across * edge.across + edge.residual * edge.residual;
    least = select(visible, minimum(least, squared), least);
    outside = either(outside, visible);
  }
  return at.x * at.x + select(outside, least, zero);
}

// A lane for each point.
[[gnu::flatten]] void measure(LocalPoints& points, std::span<const LocalFrame> triangles) {
  using Real = Lanes<hn::ScalableTag<double>>;
  for (std::size_t i = 0; i < points.count; i += Real::kCount) {
    const kernel::Vector3<Real> p = {Real::load_unaligned(&points.x[i]),
                                     Real::load_unaligned(&points.y[i]),
                                     Real::load_unaligned(&points.z[i])};
    Real best(1e300), which(0.0);
    double index = 0;
    for (const LocalFrame& triangle : triangles) {
      const Real squared = squared_distance_of(on_all_lanes<Real>(triangle), p);
      const auto nearer = squared < best;
      best = select(nearer, squared, best);
      which = select(nearer, Real(index), which);
      index += 1;
    }
    best.store_unaligned(&points.squared[i]);
    which.store_unaligned(&points.nearest[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sw_model/model/triangle_frame.h"

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
  const auto vector = [](const Point& v) { return Vector3<double>{v[0], v[1], v[2]}; };
  const auto edge = [](double y, double z) {
    const double length = std::sqrt(y * y + z * z);
    return PlanarEdge<double>{{y / length, z / length}, length};
  };
  const Point u = corners[1] - corners[0];
  const Point w = corners[2] - corners[0];
  const double length = u.norm();
  const Point along = u / length;
  const Point normal = u.cross(w).normalized();
  const Point in_plane = normal.cross(along);
  const double y = in_plane.dot(w), z = along.dot(w);
  return {vector(corners[0]),
          vector(normal),
          vector(in_plane),
          vector(along),
          length,
          edge(y, z),
          edge(y, z - length),
          0};
}

Foot foot_on(const LocalFrame& f, const Point& p) {
  const Vector3<double> at = to_frame(f, {p[0], p[1], p[2]});
  const TriangleView<double> view = view_edges(f, at.y, at.z);
  double foot_y = at.y, foot_z = at.z, best = 1e300;
  const auto edge = [&](const EdgeView<double>& seen, const PlanarEdge<double>& e, double from_z) {
    if (seen.across >= 0) return;
    const double squared = seen.across * seen.across + seen.residual * seen.residual;
    if (squared >= best) return;
    best = squared;
    const double on_edge = std::clamp(seen.along, 0.0, e.length);
    foot_y = on_edge * e.direction.y;
    foot_z = from_z + on_edge * e.direction.z;
  };
  edge(view.edge12, {{0, 1}, f.length12}, 0);
  edge(view.edge13, f.edge13, 0);
  edge(view.edge23, f.edge23, f.length12);
  const Vector2<double>& e3 = f.edge23.direction;
  Foot foot;
  foot.residual = at.x * eigen(f.normal) + (at.y - foot_y) * eigen(f.in_plane) +
                  (at.z - foot_z) * eigen(f.along);
  // Heights over edge 2-3: of the foot (at_foot), and of the first corner (the divisor).
  const double at_foot = foot_y * e3.z - (foot_z - f.length12) * e3.y;
  foot.weight = std::clamp(at_foot / (f.length12 * e3.y), 0.0, 1.0);
  const double distance = foot.residual.norm();
  foot.direction = best < 1e300 && distance > 0 ? Point(foot.residual / distance) : eigen(f.normal);
  return foot;
}

}  // namespace emax

#endif
