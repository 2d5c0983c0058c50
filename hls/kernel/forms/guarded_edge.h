// Squared distance from a point to a triangle, visible-edge form for coarse fixed-point numbers:
// see point_triangle.h for the symbols. The fixed-point filter's form
// (sw_model/model/fixed_filter.h).
//
// With steps of 2^-16 a point beyond a sharp corner at V1 or V2 can lie within a step of both lines
// that meet there, and far from the corner. No edge sees it by the sign of its h. Such a point lies
// beyond an end of V1V2, so there the edge from this end counts as visible too:
//
//   edge 2 is visible where h2 < 0 or z < 0, edge 3 where h3 < 0 or z > L1
//
// In exact arithmetic this changes no distance. With rounding, a result can be too small by no more
// than some steps for a triangle of any shape (docs/numerics.md). It can be too large by more for a
// flat one, whose apex has nearly 180 degrees.
//
// Products and their sums are exact, and each coordinate is rounded to a Scalar once.
// 20 multiplications and 18 additions.
#ifndef EMAX_HLS_KERNEL_FORMS_GUARDED_EDGE_H
#define EMAX_HLS_KERNEL_FORMS_GUARDED_EDGE_H

#include "hls/kernel/fixed.h"
#include "hls/kernel/point_triangle.h"

namespace emax {

// Holds sums of three products of two Scalars: they need no rounding and never wrap around. Of
// scalars that are not fixed-point numbers it is Scalar itself.
template <class Scalar>
struct SumOfProductsOf {
  using Type = Scalar;
};
template <template <int, int, Rounding, Overflow> class Number, int kWidth, int kFraction,
          Rounding kRounding, Overflow kOverflow>
struct SumOfProductsOf<Number<kWidth, kFraction, kRounding, kOverflow>> {
  using Type = Number<2 * kWidth + 1, 2 * kFraction, Rounding::kDown, Overflow::kWrap>;
};
template <class Scalar>
using SumOfProducts = typename SumOfProductsOf<Scalar>::Type;

// Holds squares below 1 exactly; every greater one is its greatest number, which says that the
// distance is too great to be of use. Of scalars that are not fixed-point numbers it is Scalar
// itself.
template <class Scalar>
struct SquareBelowOneOf {
  using Type = Scalar;
};
template <template <int, int, Rounding, Overflow> class Number, int kWidth, int kFraction,
          Rounding kRounding, Overflow kOverflow>
struct SquareBelowOneOf<Number<kWidth, kFraction, kRounding, kOverflow>> {
  using Type = Number<2 * kFraction + 1, 2 * kFraction, Rounding::kDown, Overflow::kSaturate>;
};
template <class Scalar>
using SquareBelowOne = typename SquareBelowOneOf<Scalar>::Type;

template <class Scalar>
Scalar rounded_dot(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  using Wide = SumOfProducts<Scalar>;
  return Scalar(product<Wide>(a.x, b.x) + product<Wide>(a.y, b.y) + product<Wide>(a.z, b.z));
}

// view_edges() with each coordinate rounded once.
template <class Scalar>
TriangleView<Scalar> rounded_view(const TriangleRecord<Scalar>& t, const Scalar& y,
                                  const Scalar& z) {
  using Wide = SumOfProducts<Scalar>;
  const Scalar z_from_v2 = z - t.length12;
  const Vector2<Scalar>& e2 = t.edge13.direction;
  const Vector2<Scalar>& e3 = t.edge23.direction;
  const Scalar along13 = Scalar(product<Wide>(y, e2.y) + product<Wide>(z, e2.z));
  const Scalar across13 = Scalar(product<Wide>(z, e2.y) - product<Wide>(y, e2.z));
  const Scalar along23 = Scalar(product<Wide>(y, e3.y) + product<Wide>(z_from_v2, e3.z));
  const Scalar across23 = Scalar(product<Wide>(y, e3.z) - product<Wide>(z_from_v2, e3.y));
  return {{y, z, edge_residual(z, z_from_v2)},
          {across13, along13, edge_residual(along13, Scalar(along13 - t.edge13.length))},
          {across23, along23, edge_residual(along23, Scalar(along23 - t.edge23.length))}};
}

template <class Scalar, class Condition>
SumOfProducts<Scalar> squared_distance_guarded(const TriangleRecord<Scalar>& t,
                                               const Condition& segment, const Vector3<Scalar>& p) {
  using Wide = SumOfProducts<Scalar>;
  const Scalar zero(0.0f);
  const Vector3<Scalar> q = {p.x - t.v1.x, p.y - t.v1.y, p.z - t.v1.z};
  const Scalar x = rounded_dot(t.normal, q);
  const Scalar y = rounded_dot(t.in_plane, q);
  const Scalar z = rounded_dot(t.along, q);
  const TriangleView<Scalar> view = rounded_view(t, y, z);
  const auto before_v1 = view.edge12.residual < zero;
  const auto beyond_v2 = zero < view.edge12.residual;
  const auto visible12 = either(y < zero, segment);
  const auto visible13 = both(either(view.edge13.across < zero, before_v1), negated(segment));
  const auto visible23 = both(either(view.edge23.across < zero, beyond_v2), negated(segment));
  const auto nearest = nearest_edge(view, visible12, visible13, visible23);

  const Wide no_square(0.0f);
  const Wide off_plane = product<Wide>(x, x);
  const Wide in_plane = product<Wide>(nearest.across, nearest.across) +
                        product<Wide>(nearest.residual, nearest.residual);
  return off_plane + select(nearest.outside, in_plane, no_square);
}

// The filtering core's number of a pair, which orders pairs as their distances below 1.
template <class Scalar, class Condition>
SquareBelowOne<Scalar> squared_distance_below_one(const TriangleRecord<Scalar>& t,
                                                  const Condition& segment,
                                                  const Vector3<Scalar>& p) {
  return SquareBelowOne<Scalar>(squared_distance_guarded(t, segment, p));
}

}  // namespace emax

#endif
