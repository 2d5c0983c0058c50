// A function that needs only some bits of the numbers that it computes.
#pragma once

#include "hls/kernel/scalar.h"

template <class Scalar>
Scalar signs_alone(Scalar a, Scalar b, Scalar c, Scalar d) {
  using emax::select;
  const Scalar zero(0.0f);
  const Scalar upper = select(a * b < zero, magnitude(c), d);
  return select(zero < a - b, upper, magnitude(upper + c));
}
