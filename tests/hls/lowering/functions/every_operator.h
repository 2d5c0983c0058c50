// A function with every operator that a lowered function may use, on every kind of value.
#pragma once

#include "hls/kernel/square_root.h"

template <class Scalar>
struct Operands {
  Scalar a, b;
  emax::ConditionOf<Scalar> choice;
};

template <class Scalar>
struct Results {
  Scalar sum, difference, product, square, quotient, root, opposite, opposite_of_sum, size, chosen;
  emax::ConditionOf<Scalar> logic;
};

template <class Scalar>
struct Comparisons {
  emax::ConditionOf<Scalar> less, greater, at_most, at_least, equal, different, of_opposites;
  emax::ConditionOf<Scalar> below_zero, above_zero, computed_below_zero, computed_above_zero;
};

template <class Scalar>
struct Everything {
  Results<Scalar> results;
  Comparisons<Scalar> comparisons;
  Scalar unchanged, constant;
};

template <class Scalar>
Everything<Scalar> every_operator(const Operands<Scalar>& in, Scalar other) {
  using emax::both, emax::either, emax::negated, emax::select, emax::square_root;
  const Scalar a = in.a, b = in.b;
  const Scalar zero(0.0f);
  const Scalar sum = a + b;
  const Scalar product = a * b;
  return {{sum, a - b, product, a * a, a / b, square_root(other), -a, -sum, magnitude(sum),
           select(in.choice, a, other), either(both(in.choice, a < zero), negated(in.choice))},
          {a<b, a> b, a <= b, a >= b, a == b, a != b, -sum < -a, other < zero, zero < other,
           product < zero, zero < product},
          other,
          Scalar(0.25f)};
}
