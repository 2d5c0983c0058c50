// The distance of a point from a segment in space, which may be a point itself.
#pragma once

#include "hls/kernel/square_root.h"

template <class Scalar>
struct Segment {
  emax::Vector3<Scalar> from, to;
};

template <class Scalar>
Scalar dot(const emax::Vector3<Scalar>& a, const emax::Vector3<Scalar>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Scalar>
emax::Vector3<Scalar> difference(const emax::Vector3<Scalar>& a, const emax::Vector3<Scalar>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Scalar>
Scalar point_segment(const emax::Vector3<Scalar>& p, const Segment<Scalar>& segment) {
  using emax::select, emax::square_root;
  const Scalar zero(0.0f), one(1.0f);
  const emax::Vector3<Scalar> along = difference(segment.to, segment.from);
  const emax::Vector3<Scalar> to_point = difference(p, segment.from);
  const Scalar length_squared = dot(along, along);
  // The quotient is NaN for a segment that is a point; no comparison with NaN is true.
  const Scalar place = dot(to_point, along) / length_squared;
  const Scalar before_end = select(place < one, place, one);
  const Scalar within = select(zero < place, before_end, zero);
  const emax::Vector3<Scalar> nearest = {within * along.x, within * along.y, within * along.z};
  const emax::Vector3<Scalar> away = difference(to_point, nearest);
  return square_root(dot(away, away));
}
