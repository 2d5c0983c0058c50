// Squared distance from a point to a triangle, visible-edge form: the kernel's arithmetic.
//
//   q = P - V1;  (x, y, z) = R q;  zl = z - L1
//   edge 1 (V1V2):  s1 = z                      h1 = y
//   edge 2 (V1V3):  s2 = y e2y + z e2z          h2 = z e2y - y e2z
//   edge 3 (V2V3):  s3 = y e3y + zl e3z         h3 = y e3z - zl e3y
//   r = s < 0 ? s : max(s - L, 0)               how far s lies beyond the edge's ends
//   d^2 = x^2 + (no h < 0 ? 0 : h^2 + r^2 of the edge with h < 0 and the least |r|)
//
// The nearest point of a triangle to a point outside lies on an edge that the point sees (h < 0),
// and among those it is the one with the least |r|; at equal |r| the lower edge number is taken.
// h1, h2 and h3 are the barycentric coordinates of the paper (section 4), each scaled by a height.
// 20 multiplications and 18 additions; the order of the operations is part of the numeric contract.
#ifndef EMAX_HLS_KERNEL_POINT_TRIANGLE_H
#define EMAX_HLS_KERNEL_POINT_TRIANGLE_H
#include "hls/kernel/scalar.h"
#include "hls/kernel/triangle_record.h"

namespace emax {

// P in the frame of the triangle: x off the plane, y and z in it.
template <class Scalar>
Vector3<Scalar> to_frame(const TriangleRecord<Scalar>& t, const Vector3<Scalar>& p) {
  const Vector3<Scalar> q = {p.x - t.v1.x, p.y - t.v1.y, p.z - t.v1.z};
  const Scalar x = t.normal.x * q.x + t.normal.y * q.y + t.normal.z * q.z;
  const Scalar y = t.in_plane.x * q.x + t.in_plane.y * q.y + t.in_plane.z * q.z;
  const Scalar z = t.along.x * q.x + t.along.y * q.y + t.along.z * q.z;
  return {x, y, z};
}

// How far `s`, a coordinate along an edge, lies beyond the edge's ends; `beyond_end` is s - length.
template <class Scalar>
Scalar edge_residual(const Scalar& s, const Scalar& beyond_end) {
  const Scalar zero(0.0f);
  return select(s < zero, s, select(zero < beyond_end, beyond_end, zero));
}

// An edge seen from a point in the plane: the signed distance to the edge's line (negative on the
// outer side), the coordinate along the edge, and its residual.
template <class Scalar>
struct EdgeView {
  Scalar across, along, residual;
};

template <class Scalar>
struct TriangleView {
  EdgeView<Scalar> edge12, edge13, edge23;
};

template <class Scalar>
TriangleView<Scalar> view_edges(const TriangleRecord<Scalar>& t, const Scalar& y, const Scalar& z) {
  const Scalar z_from_v2 = z - t.length12;
  const Vector2<Scalar>& e2 = t.edge13.direction;
  const Vector2<Scalar>& e3 = t.edge23.direction;
  const Scalar along13 = y * e2.y + z * e2.z;
  const Scalar across13 = z * e2.y - y * e2.z;
  const Scalar along23 = y * e3.y + z_from_v2 * e3.z;
  const Scalar across23 = y * e3.z - z_from_v2 * e3.y;
  return {{y, z, edge_residual(z, z_from_v2)},
          {across13, along13, edge_residual(along13, Scalar(along13 - t.edge13.length))},
          {across23, along23, edge_residual(along23, Scalar(along23 - t.edge23.length))}};
}

// Where a point in the plane of a triangle is nearest to it.
template <class Scalar, class Condition>
struct NearestEdge {
  Scalar across, residual;
  Condition outside;  // else the point is inside, and the edge says nothing
};

// Of the visible edges the one with the least |r|. An edge of higher number is chosen only where
// its residual is smaller: ties go to the lower.
template <class Scalar, class Condition>
NearestEdge<Scalar, Condition> nearest_edge(const TriangleView<Scalar>& view,
                                            const Condition& visible12, const Condition& visible13,
                                            const Condition& visible23) {
  const auto prefer23 =
      both(visible23, either(negated(visible13),
                             magnitude(view.edge23.residual) < magnitude(view.edge13.residual)));
  const Scalar across_upper = select(prefer23, view.edge23.across, view.edge13.across);
  const Scalar residual_upper = select(prefer23, view.edge23.residual, view.edge13.residual);
  const auto visible_upper = either(visible13, visible23);
  const auto prefer_upper =
      both(visible_upper,
           either(negated(visible12), magnitude(residual_upper) < magnitude(view.edge12.residual)));
  const Scalar across = select(prefer_upper, across_upper, view.edge12.across);
  const Scalar residual = select(prefer_upper, residual_upper, view.edge12.residual);

  const auto outside = either(visible12, visible_upper);
  return {across, residual, outside};
}

// `segment` is the record's flag: the triangle is degenerate and only edge 1 counts.
// Works on any Scalar and its condition type; exact to the bit for a given Scalar. Error against
// the true distance: docs/numerics.md.
template <class Scalar, class Condition>
Scalar squared_distance(const TriangleRecord<Scalar>& t, const Condition& segment,
                        const Vector3<Scalar>& p) {
  const Scalar zero(0.0f);
  const Vector3<Scalar> frame = to_frame(t, p);
  const TriangleView<Scalar> view = view_edges(t, frame.y, frame.z);
  const auto visible12 = either(view.edge12.across < zero, segment);
  const auto visible13 = both(view.edge13.across < zero, negated(segment));
  const auto visible23 = both(view.edge23.across < zero, negated(segment));
  const auto nearest = nearest_edge(view, visible12, visible13, visible23);

  const Scalar off_plane = frame.x * frame.x;
  const Scalar in_plane = nearest.across * nearest.across + nearest.residual * nearest.residual;
  return off_plane + select(nearest.outside, in_plane, zero);
}

}  // namespace emax

#endif
