// Squared distance from a point to a triangle, the paper's literal form (section 4): barycentric
// coordinates (u, v) with their constant terms precomputed decide whether the projection lies
// inside; outside, the normalised projection t onto each edge, clamped to [0, 1], gives the nearest
// point of that edge. A check on the visible-edge form and a peer in benchmarks.
#pragma once

#include "hls/kernel/point_triangle.h"

namespace emax {

// The triangle in its own frame: V1 = (0, 0), V2 = (0, v2_z), V3 = (v3_y, v3_z).
template <class Scalar>
struct BarycentricRecord {
  TriangleRecord<Scalar> frame;  // only its translation, rotation and length12 are used
  Vector2<Scalar> v3;
  Scalar inverse_determinant;  // 1 / ((V2.y - V3.y)(V1.z - V3.z) + (V3.z - V2.z)(V1.y - V3.y))
  Scalar inverse_length12_squared, inverse_length13_squared, inverse_length23_squared;
};

// Squared distance in the plane from (y, z) to the segment from `start` along `edge`.
template <class Scalar>
Scalar squared_distance_to_edge(const Scalar& y, const Scalar& z, const Vector2<Scalar>& start,
                                const Vector2<Scalar>& edge, const Scalar& inverse_length_squared) {
  const Scalar zero(0.0f), one(1.0f);
  const Scalar from_y = y - start.y, from_z = z - start.z;
  const Scalar t = (from_y * edge.y + from_z * edge.z) * inverse_length_squared;
  const Scalar clamped = select(t < zero, zero, select(one < t, one, t));
  const Scalar off_y = from_y - clamped * edge.y, off_z = from_z - clamped * edge.z;
  return off_y * off_y + off_z * off_z;
}

template <class Scalar, class Condition>
Scalar squared_distance_barycentric(const BarycentricRecord<Scalar>& t, const Condition& segment,
                                    const Vector3<Scalar>& p) {
  const Scalar zero(0.0f), one(1.0f);
  const Vector3<Scalar> frame = to_frame(t.frame, p);
  const Scalar v2_z = t.frame.length12;
  const Vector2<Scalar> v1 = {zero, zero}, v2 = {zero, v2_z};
  const Vector2<Scalar> edge12 = {zero, v2_z};
  const Vector2<Scalar> edge23 = {t.v3.y, t.v3.z - v2_z};

  const Scalar from_v3_y = frame.y - t.v3.y, from_v3_z = frame.z - t.v3.z;
  const Scalar u = (edge23.z * from_v3_y - t.v3.y * from_v3_z) * t.inverse_determinant;
  const Scalar v = (t.v3.y * from_v3_z - t.v3.z * from_v3_y) * t.inverse_determinant;
  const auto outside = either(either(u < zero, v < zero), one < u + v);

  const Scalar to12 =
      squared_distance_to_edge(frame.y, frame.z, v1, edge12, t.inverse_length12_squared);
  const Scalar to13 =
      squared_distance_to_edge(frame.y, frame.z, v1, t.v3, t.inverse_length13_squared);
  const Scalar to23 =
      squared_distance_to_edge(frame.y, frame.z, v2, edge23, t.inverse_length23_squared);
  const Scalar nearer = select(to13 < to12, to13, to12);
  const Scalar nearest = select(to23 < nearer, to23, nearer);
  const Scalar in_plane = select(segment, to12, select(outside, nearest, zero));
  return frame.x * frame.x + in_plane;
}

}  // namespace emax
