// A function with every operator of fixed-point numbers that a lowered function may use, and
// changes of format of every kind.
#pragma once

#include "hls/kernel/fixed.h"

template <class Scalar>
struct FixedOperands {
  Scalar a, b;
  emax::WithFormat<Scalar, 40, 33> wide;
  emax::ConditionOf<Scalar> choice;
};

template <class Scalar>
struct FixedResults {
  Scalar sum, difference, product, opposite, size, chosen, unchanged, constant;
};

template <class Scalar>
struct FixedComparisons {
  emax::ConditionOf<Scalar> less, greater, at_most, at_least, equal, different, negative;
};

template <class Scalar>
struct FixedFormats {
  emax::WithFormat<Scalar, 36, 32> exact;
  emax::WithFormat<Scalar, 62, 36> beyond;
  emax::WithFormat<Scalar, 9, 0> whole;
  emax::WithFormat<Scalar, 20, 18> longer;
  emax::WithFormat<Scalar, 2, 1> shortest;
  Scalar narrowed;
};

template <class Scalar>
struct FixedEverything {
  FixedResults<Scalar> results;
  FixedComparisons<Scalar> comparisons;
  FixedFormats<Scalar> formats;
};

template <class Scalar>
FixedEverything<Scalar> every_fixed_operator(const FixedOperands<Scalar>& in) {
  using emax::product, emax::select, emax::WithFormat;
  using Exact = WithFormat<Scalar, 36, 32>;
  using Beyond = WithFormat<Scalar, 62, 36>;
  const Scalar a = in.a, b = in.b;
  const Exact exact = product<Exact>(a, b);
  const Beyond beyond = product<Beyond>(a, b) + product<Beyond>(a, a);
  const WithFormat<Scalar, 9, 0> whole(a);
  const WithFormat<Scalar, 20, 18> longer(b);
  const WithFormat<Scalar, 2, 1> shortest(in.wide);
  return {{a + b, a - b, a * b, -a, magnitude(b), select(in.choice, a, b), b, Scalar(0.7)},
          {a<b, a> b, a <= b, a >= b, a == b, a != b, exact < Exact(0.0)},
          {exact, beyond, whole, longer, shortest, Scalar(in.wide)}};
}
