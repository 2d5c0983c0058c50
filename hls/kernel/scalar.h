// The operations that the kernel's arithmetic is written in, for binary32 and binary64. A scalar of
// another kind (flushing, recording) declares the same names beside its own type; they are found by
// argument. Conditions are never turned into control flow, so a scalar whose comparisons have no
// truth value still compiles.
#ifndef EMAX_HLS_KERNEL_SCALAR_H
#define EMAX_HLS_KERNEL_SCALAR_H

namespace emax {

inline float select(bool condition, float if_true, float if_false) {
  return condition ? if_true : if_false;
}
inline double select(bool condition, double if_true, double if_false) {
  return condition ? if_true : if_false;
}
inline float magnitude(float value) { return value < 0.0f ? -value : value; }
inline double magnitude(double value) { return value < 0.0 ? -value : value; }

// No short circuit: both sides are computed, as wires in hardware are.
inline bool both(bool a, bool b) { return (a & b) != 0; }
inline bool either(bool a, bool b) { return (a | b) != 0; }
inline bool negated(bool a) { return !a; }

// What a comparison of scalars gives.
template <class Scalar>
using ConditionOf = decltype(Scalar() < Scalar());

template <class Scalar>
struct Vector3 {
  Scalar x, y, z;
};

// A vector in the plane of a triangle: y across V1V2, z along it.
template <class Scalar>
struct Vector2 {
  Scalar y, z;
};

}  // namespace emax

#endif
