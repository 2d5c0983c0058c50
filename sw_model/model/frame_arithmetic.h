// The arithmetic of a triangle's frame (triangle_frame.h), written once for a double and for a
// vector of doubles. Every lane has the same operations in the same order, so records have the same
// bits whoever makes them. A lane type declares select, either, negated, any, square_root and the
// operators beside itself, as kernel scalars do (hls/kernel/scalar.h).
#ifndef EMAX_SW_MODEL_FRAME_ARITHMETIC_H
#define EMAX_SW_MODEL_FRAME_ARITHMETIC_H

#include <array>
#include <cmath>

#include "hls/kernel/triangle_record.h"

namespace emax {

inline double square_root(double value) { return std::sqrt(value); }
inline bool any(bool condition) { return condition; }

// A triangle whose height over its longest edge is below this part of it is a segment.
constexpr double kSliverRatio = 1e-6;
// A longest edge shorter than this, normalised, has no direction, because squares of lengths and of
// heights would underflow. The triangle is then a point for the kernel.
constexpr double kSmallestLength = 0x1p-400;

template <class Real>
Vector3<Real> operator-(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Real>
Vector3<Real> scaled(const Vector3<Real>& v, const Real& factor) {
  return {v.x * factor, v.y * factor, v.z * factor};
}

template <class Real>
Real dot(const Vector3<Real>& a, const Vector3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
Vector3<Real> cross(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Condition, class Real>
Vector3<Real> select(const Condition& condition, const Vector3<Real>& if_true,
                     const Vector3<Real>& if_false) {
  return {select(condition, if_true.x, if_false.x), select(condition, if_true.y, if_false.y),
          select(condition, if_true.z, if_false.z)};
}

template <class Real, class Condition>
struct FrameOf {
  TriangleRecord<Real> record;  // its tag is not set
  Vector2<Real> v3;             // in the frame
  Condition segment;
};

// Any unit vector across the unit vector `axis`, the same one for the same axis.
template <class Real>
Vector3<Real> across(const Vector3<Real>& axis) {
  const Real x = magnitude(axis.x), y = magnitude(axis.y), z = magnitude(axis.z);
  const auto is_z = both(z < x, z < y);
  const auto is_y = both(y < x, negated(is_z));
  const Real zero(0.0), one(1.0);
  const Vector3<Real> unit = {select(either(is_y, is_z), zero, one), select(is_y, one, zero),
                              select(is_z, one, zero)};
  const Vector3<Real> v = cross(axis, unit);
  return scaled(v, one / square_root(dot(v, v)));
}

// An edge of length 0 has the direction (0, 1).
template <class Real>
PlanarEdge<Real> planar_edge(const Vector2<Real>& v) {
  const Real zero(0.0), one(1.0);
  const Real length = square_root(v.y * v.y + v.z * v.z);
  const auto has_length = zero < length;
  const Real inverse = one / select(has_length, length, one);
  return {{select(has_length, v.y * inverse, zero), select(has_length, v.z * inverse, one)},
          length};
}

// Corners in normalised units, finite.
template <class Real>
auto frame_of(const std::array<Vector3<Real>, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Real zero(0.0), one(1.0);
  const Vector3<Real> ab = b - a, bc = c - b, ca = a - c;
  const Real ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
  const auto bc_is_longest = both(ab2 < bc2, negated(bc2 < ca2));
  const auto ca_is_longest = both(ab2 < ca2, bc2 < ca2);

  FrameOf<Real, decltype(ab2 < bc2)> frame{};
  TriangleRecord<Real>& record = frame.record;
  record.v1 = select(ca_is_longest, c, select(bc_is_longest, b, a));
  const Vector3<Real> v2 = select(ca_is_longest, a, select(bc_is_longest, c, b));
  const Vector3<Real> v3 = select(ca_is_longest, b, select(bc_is_longest, a, c));
  const Vector3<Real> to2 = v2 - record.v1, to3 = v3 - record.v1;

  record.length12 = square_root(dot(to2, to2));
  const auto is_point = record.length12 < Real(kSmallestLength);
  record.length12 = select(is_point, zero, record.length12);
  record.along = select(is_point, Vector3<Real>{zero, zero, one},
                        scaled(to2, one / select(is_point, one, record.length12)));
  const Vector3<Real> off_axis = to3 - scaled(record.along, dot(record.along, to3));
  const Real height = square_root(dot(off_axis, off_axis));
  frame.segment = either(height < Real(kSliverRatio) * record.length12, is_point);
  Vector3<Real> upwards = scaled(off_axis, one / select(frame.segment, one, height));
  if (any(frame.segment)) upwards = select(frame.segment, across(record.along), upwards);
  // Orthogonalised twice: once leaves a cancellation error of the size of the sliver ratio.
  const Vector3<Real> in_plane = upwards - scaled(record.along, dot(record.along, upwards));
  record.in_plane = scaled(in_plane, one / square_root(dot(in_plane, in_plane)));
  record.normal = cross(record.in_plane, record.along);

  frame.v3 = {dot(record.in_plane, to3), dot(record.along, to3)};
  const Vector2<Real> edge23 = {frame.v3.y, frame.v3.z - record.length12};
  record.edge13 = planar_edge(frame.v3);
  record.edge23 = planar_edge(edge23);
  return frame;
}

}  // namespace emax

#endif
