// Squared distance from a point to a triangle, three-edge form: the least over all edges unless the
// point projects inside. 24 multiplications and 20 additions. A check on the visible-edge form and
// a peer in benchmarks; see point_triangle.h for the symbols.
#pragma once

#include "hls/kernel/point_triangle.h"

namespace emax {

template <class Scalar, class Condition>
Scalar squared_distance_three_edge(const TriangleRecord<Scalar>& t, const Condition& segment,
                                   const Vector3<Scalar>& p) {
  const Scalar zero(0.0f);
  const Vector3<Scalar> frame = to_frame(t, p);
  const TriangleView<Scalar> view = view_edges(t, frame.y, frame.z);
  const Scalar edge12 =
      view.edge12.across * view.edge12.across + view.edge12.residual * view.edge12.residual;
  const Scalar edge13 =
      view.edge13.across * view.edge13.across + view.edge13.residual * view.edge13.residual;
  const Scalar edge23 =
      view.edge23.across * view.edge23.across + view.edge23.residual * view.edge23.residual;
  const auto outside = either(view.edge12.across < zero,
                              either(view.edge13.across < zero, view.edge23.across < zero));
  const Scalar nearer = select(edge13 < edge12, edge13, edge12);
  const Scalar nearest = select(edge23 < nearer, edge23, nearer);
  const Scalar in_plane = select(segment, edge12, select(outside, nearest, zero));
  return frame.x * frame.x + in_plane;
}

}  // namespace emax
