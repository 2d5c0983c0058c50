// A function whose record is two of its four parameters, with a condition among its numbers, and
// which needs the record's fields in several cycles.
#pragma once

#include "hls/kernel/scalar.h"

template <class Scalar>
struct Range {
  emax::ConditionOf<Scalar> is_open;
  Scalar from, to;
};

template <class Scalar>
Scalar scaled_in_range(const Range<Scalar>& range, Scalar x,
                       const emax::ConditionOf<Scalar>& always, Scalar gain) {
  using emax::both, emax::either, emax::negated, emax::select;
  const Scalar scaled = x * x - range.from;
  const auto inside = both(negated(range.is_open), scaled < range.to);
  return select(either(inside, always), scaled * gain, x);
}
