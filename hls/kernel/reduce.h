// The two streaming reductions: min over the triangles of a point, max over the points with the
// index of the worst. Squared distances are non-negative binary32 values, which order like their
// bits, so both are integer compares with an initiation interval of one.
#pragma once

#include "hls/kernel/word.h"

namespace emax {

inline Word select(bool condition, Word if_true, Word if_false) {
  return condition ? if_true : if_false;
}

constexpr Word kInfinityWord = 0x7f800000u;  // a point that has met no triangle yet

template <class Value>
Value minimum(const Value& a, const Value& b) {
  return select(b < a, b, a);
}

// The worst point so far: greatest squared distance, and where it was first seen.
template <class Value>
struct WorstPoint {
  Value squared_distance;
  Value index;
};

// Points come in rising order of index: an equal distance keeps the lower index.
template <class Value>
WorstPoint<Value> maximum(const WorstPoint<Value>& so_far, const WorstPoint<Value>& next) {
  const auto worse = so_far.squared_distance < next.squared_distance;
  return {select(worse, next.squared_distance, so_far.squared_distance),
          select(worse, next.index, so_far.index)};
}

}  // namespace emax
