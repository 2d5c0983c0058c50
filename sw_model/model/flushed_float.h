#pragma once

#include <cmath>

#include "sw_model/base/float_bits.h"

namespace emax {

// The model's scalar: IEEE binary32 to nearest even with subnormals flushed, whatever the mode of
// the processor. Subnormal inputs count as signed zero; a result is flushed to signed zero when it
// is tiny after rounding at unbounded exponent; a NaN result is 0x7fc00000 (docs/numerics.md).
//
// Each operation is computed in binary64 and rounded once more to binary32. The two roundings give
// the same bits as one, because binary64 has 53 >= 2 * 24 + 2 digits.
class FlushedFloat {
 public:
  FlushedFloat() = default;
  explicit constexpr FlushedFloat(float value) : value_(value) {}

  constexpr float value() const { return value_; }

  friend FlushedFloat operator+(FlushedFloat a, FlushedFloat b) {
    return rounded(a.operand() + b.operand());
  }
  friend FlushedFloat operator-(FlushedFloat a, FlushedFloat b) {
    return rounded(a.operand() - b.operand());
  }
  friend FlushedFloat operator*(FlushedFloat a, FlushedFloat b) {
    return rounded(a.operand() * b.operand());
  }
  friend FlushedFloat operator/(FlushedFloat a, FlushedFloat b) {
    return rounded(a.operand() / b.operand());
  }
  friend FlushedFloat square_root(FlushedFloat a) { return rounded(std::sqrt(a.operand())); }
  // The sign alone, as of IEEE 754: no operand is flushed, and a NaN gets the other sign too.
  friend FlushedFloat operator-(FlushedFloat a) {
    return FlushedFloat(bits_float(float_bits(a.value_) ^ kSignBit));
  }
  friend bool operator<(FlushedFloat a, FlushedFloat b) { return a.operand() < b.operand(); }
  friend bool operator>(FlushedFloat a, FlushedFloat b) { return a.operand() > b.operand(); }
  friend bool operator<=(FlushedFloat a, FlushedFloat b) { return a.operand() <= b.operand(); }
  friend bool operator>=(FlushedFloat a, FlushedFloat b) { return a.operand() >= b.operand(); }
  friend bool operator==(FlushedFloat a, FlushedFloat b) { return a.operand() == b.operand(); }
  friend bool operator!=(FlushedFloat a, FlushedFloat b) { return a.operand() != b.operand(); }

 private:
  double operand() const {
    return is_subnormal_bits(float_bits(value_)) ? std::copysign(0.0, static_cast<double>(value_))
                                                 : static_cast<double>(value_);
  }

  static FlushedFloat rounded(double exact) {
    constexpr double kTiny = 0x1p-126 * (1 - 0x1p-25);
    if (std::isnan(exact)) return FlushedFloat(bits_float(kCanonicalNan));
    if (std::abs(exact) < kTiny)
      return FlushedFloat(std::copysign(0.0f, static_cast<float>(exact)));
    return FlushedFloat(static_cast<float>(exact));
  }

  float value_;
};

inline FlushedFloat select(bool condition, FlushedFloat if_true, FlushedFloat if_false) {
  return condition ? if_true : if_false;
}
inline FlushedFloat magnitude(FlushedFloat value) {
  return FlushedFloat(bits_float(float_bits(value.value()) & ~kSignBit));
}
inline std::uint32_t to_word(FlushedFloat value) { return float_bits(value.value()); }

}  // namespace emax
