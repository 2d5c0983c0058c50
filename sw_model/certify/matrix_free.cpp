#include "sw_model/certify/matrix_free.h"

#include <algorithm>

namespace emax {
namespace {

template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;

// numerator / denominator clamped to [0, 1], for denominator > 0; divides only inside that range.
template <class Scalar>
Scalar clamped_ratio(Scalar numerator, Scalar denominator) {
  if (numerator <= 0) return 0;
  return numerator >= denominator ? Scalar(1) : numerator / denominator;
}

// Inlined into both callers: the benchmarks would measure a call.
template <class Scalar>
[[gnu::always_inline]] inline Vector<Scalar> offset(const Vector<Scalar>& p,
                                                    const Vector<Scalar>& a,
                                                    const Vector<Scalar>& b,
                                                    const Vector<Scalar>& c) {
  const Vector<Scalar> ab = b - a, ac = c - a;
  Vector<Scalar> ap = p - a;
  const Scalar d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap;

  Vector<Scalar> bp = p - b;
  const Scalar d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp;

  const Scalar vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return ap - d1 / (d1 - d3) * ab;

  Vector<Scalar> cp = p - c;
  const Scalar d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp;

  const Scalar vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return ap - d2 / (d2 - d6) * ac;

  const Scalar va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const Scalar scale = 1 / (va + vb + vc);
  return ap - vb * scale * ab - vc * scale * ac;
}

}  // namespace

template <class Scalar>
Vector<Scalar> ericson_offset(const Vector<Scalar>& p, const Vector<Scalar>& a,
                              const Vector<Scalar>& b, const Vector<Scalar>& c) {
  return offset(p, a, b, c);
}

template <class Scalar>
Scalar ericson_squared_distance(const Vector<Scalar>& p, const Vector<Scalar>& a,
                                const Vector<Scalar>& b, const Vector<Scalar>& c) {
  return offset(p, a, b, c).squaredNorm();
}

template <class Scalar>
Scalar eberly_squared_distance(const Vector<Scalar>& p, const Vector<Scalar>& corner,
                               const Vector<Scalar>& corner1, const Vector<Scalar>& corner2) {
  const Vector<Scalar> edge0 = corner1 - corner, edge1 = corner2 - corner, diff = corner - p;
  const Scalar a = edge0.squaredNorm(), b = edge0.dot(edge1), c = edge1.squaredNorm();
  const Scalar d = edge0.dot(diff), e = edge1.dot(diff), f = diff.squaredNorm();
  const Scalar determinant = a * c - b * b;
  Scalar s = b * e - c * d, t = b * d - a * e;

  const auto on_edge0 = [&] { s = clamped_ratio(-d, a), t = 0; };
  const auto on_edge1 = [&] { s = 0, t = clamped_ratio(-e, c); };
  const auto on_edge2 = [&] {
    s = clamped_ratio((c + e) - (b + d), a - 2 * b + c);
    t = 1 - s;
  };
  if (s + t <= determinant) {
    if (s < 0 && t < 0) {  // region 4
      d < 0 ? on_edge0() : on_edge1();
    } else if (s < 0) {  // region 3
      on_edge1();
    } else if (t < 0) {  // region 5
      on_edge0();
    } else {  // region 0
      s /= determinant;
      t /= determinant;
    }
  } else if (s < 0) {  // region 2
    c + e > b + d ? on_edge2() : on_edge1();
  } else if (t < 0) {  // region 6
    a + d > b + e ? on_edge2() : on_edge0();
  } else {  // region 1
    on_edge2();
  }
  const Scalar squared = s * (a * s + b * t + 2 * d) + t * (b * s + c * t + 2 * e) + f;
  return std::max(squared, Scalar(0));  // cancellation can leave it slightly below
}

#define EMAX_INSTANTIATE(Scalar)                                                          \
  template Vector<Scalar> ericson_offset(const Vector<Scalar>&, const Vector<Scalar>&,    \
                                         const Vector<Scalar>&, const Vector<Scalar>&);   \
  template Scalar ericson_squared_distance(const Vector<Scalar>&, const Vector<Scalar>&,  \
                                           const Vector<Scalar>&, const Vector<Scalar>&); \
  template Scalar eberly_squared_distance(const Vector<Scalar>&, const Vector<Scalar>&,   \
                                          const Vector<Scalar>&, const Vector<Scalar>&)
EMAX_INSTANTIATE(float);
EMAX_INSTANTIATE(double);
#undef EMAX_INSTANTIATE

}  // namespace emax
