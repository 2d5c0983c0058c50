// Fixed-point numbers: signed integers of kWidth bits, two's complement, in units of 2^-kFraction.
// A format without a fraction is an integer. The arithmetic is that of the modules hls/rtl/fixed_*.
//
//   Fixed<18, 16> a(0.75), b(-1.5);     // -2 to 2 - 2^-16
//   a + b, a - b, a * b, -a             // Fixed<18, 16>
//   Fixed<36, 32> exact = product<Fixed<36, 32>>(a, b);
//   Fixed<12, 8> narrow(exact);
//
// Each operation is exact and then fitted to the format of its result, in this order:
//   rounding   kHalfUp: to the nearest unit, halves upwards; kDown: downwards, which cuts bits off
//   overflow   kSaturate: the least or the greatest number; kWrap: the low kWidth bits
// A format has both as parameters. Sums, differences, negation and magnitude need no rounding;
// comparisons are exact. There is no division and no square root.
#ifndef EMAX_HLS_KERNEL_FIXED_H
#define EMAX_HLS_KERNEL_FIXED_H

#include <cstdint>
#include <type_traits>

#include "hls/kernel/scalar.h"

namespace emax {

enum class Rounding : std::uint8_t { kDown, kHalfUp };
enum class Overflow : std::uint8_t { kWrap, kSaturate };

// The widest number and the widest exact product: 64-bit integers hold every sum and every product.
constexpr int kMostFixedBits = 62;

struct FixedFormat {
  int width;     // 2 to kMostFixedBits
  int fraction;  // 0 to width - 1
  Rounding rounding;
  Overflow overflow;
};

inline constexpr std::int64_t fixed_greatest(int width) {
  return static_cast<std::int64_t>((std::uint64_t{1} << (width - 1)) - 1);
}

// The low `width` bits as a number of two's complement.
inline constexpr std::int64_t fixed_wrapped(std::uint64_t bits, int width) {
  return static_cast<std::int64_t>(((bits & ((std::uint64_t{2} << (width - 1)) - 1)) ^
                                    (std::uint64_t{1} << (width - 1)))) -
         static_cast<std::int64_t>(std::uint64_t{1} << (width - 1));
}

// `exact`, in units of 2^-fraction, fitted to a format. The difference of the fractions is at most
// kMostFixedBits.
inline std::int64_t fixed_fitted(std::int64_t exact, int fraction, const FixedFormat& to) {
  const std::int64_t greatest = fixed_greatest(to.width), least = -greatest - 1;
  const int up = to.fraction - fraction;
  if (up >= 0) {
    if (to.overflow == Overflow::kSaturate) {
      if (exact > (greatest >> up)) return greatest;
      if (exact < (least >> up)) return least;
    }
    return fixed_wrapped(static_cast<std::uint64_t>(exact) << up, to.width);
  }
  std::int64_t rounded = exact >> -up;
  if (to.rounding == Rounding::kHalfUp) rounded += (exact >> (-up - 1)) & 1;
  if (to.overflow == Overflow::kSaturate) {
    return rounded > greatest ? greatest : rounded < least ? least : rounded;
  }
  return fixed_wrapped(static_cast<std::uint64_t>(rounded), to.width);
}

// The nearest number of a format to a constant, halves upwards. Numbers beyond the format become
// its least or greatest number, NaN becomes 0.
inline std::int64_t fixed_constant(double value, const FixedFormat& to) {
  const double scaled = value * static_cast<double>(std::uint64_t{1} << to.fraction);
  const std::int64_t greatest = fixed_greatest(to.width);
  if (scaled >= static_cast<double>(greatest)) return greatest;
  if (scaled <= -static_cast<double>(greatest) - 1) return -greatest - 1;
  if (!(scaled == scaled)) return 0;
  std::int64_t down = static_cast<std::int64_t>(scaled);
  if (static_cast<double>(down) > scaled) --down;
  const bool upper_half = scaled - static_cast<double>(down) >= 0.5;
  return upper_half && down < greatest ? down + 1 : down;
}

template <int kWidth, int kFraction, Rounding kRounding = Rounding::kHalfUp,
          Overflow kOverflow = Overflow::kSaturate>
class Fixed {
  static_assert(kWidth >= 2 && kWidth <= kMostFixedBits, "a number has 2 to 62 bits");
  static_assert(kFraction >= 0 && kFraction < kWidth,
                "the fraction has fewer bits than the number");

 public:
  using Raw = std::conditional_t<(kWidth <= 32), std::int32_t, std::int64_t>;

  static constexpr FixedFormat format() { return {kWidth, kFraction, kRounding, kOverflow}; }

  Fixed() = default;
  explicit Fixed(double constant) : raw_(static_cast<Raw>(fixed_constant(constant, format()))) {}
  // Another format's number, fitted to this one.
  template <int kOther, int kOthers, Rounding kAnyRounding, Overflow kAnyOverflow>
  explicit Fixed(const Fixed<kOther, kOthers, kAnyRounding, kAnyOverflow>& other)
      : Fixed(fitted(other.raw(), kOthers)) {}

  // The integer that counts units of 2^-kFraction; its low kWidth bits count.
  static Fixed from_raw(std::int64_t raw) {
    Fixed number;
    number.raw_ = static_cast<Raw>(fixed_wrapped(static_cast<std::uint64_t>(raw), kWidth));
    return number;
  }
  std::int64_t raw() const { return raw_; }

  // `exact`, in units of 2^-fraction, fitted to this format.
  static Fixed fitted(std::int64_t exact, int fraction) {
    return from_raw(fixed_fitted(exact, fraction, format()));
  }

  explicit operator double() const {
    return static_cast<double>(raw_) / static_cast<double>(std::uint64_t{1} << kFraction);
  }

  friend Fixed operator+(const Fixed& a, const Fixed& b) {
    return fitted(a.raw() + b.raw(), kFraction);
  }
  friend Fixed operator-(const Fixed& a, const Fixed& b) {
    return fitted(a.raw() - b.raw(), kFraction);
  }
  friend Fixed operator*(const Fixed& a, const Fixed& b) {
    static_assert(2 * kWidth <= kMostFixedBits + 2, "the exact product has at most 64 bits");
    return fitted(a.raw() * b.raw(), 2 * kFraction);
  }
  friend Fixed operator-(const Fixed& a) { return fitted(-a.raw(), kFraction); }
  friend Fixed magnitude(const Fixed& a) { return a.raw() < 0 ? -a : a; }

  friend bool operator<(const Fixed& a, const Fixed& b) { return a.raw_ < b.raw_; }
  friend bool operator>(const Fixed& a, const Fixed& b) { return a.raw_ > b.raw_; }
  friend bool operator<=(const Fixed& a, const Fixed& b) { return a.raw_ <= b.raw_; }
  friend bool operator>=(const Fixed& a, const Fixed& b) { return a.raw_ >= b.raw_; }
  friend bool operator==(const Fixed& a, const Fixed& b) { return a.raw_ == b.raw_; }
  friend bool operator!=(const Fixed& a, const Fixed& b) { return a.raw_ != b.raw_; }

  friend Fixed select(bool condition, const Fixed& if_true, const Fixed& if_false) {
    return condition ? if_true : if_false;
  }

 private:
  Raw raw_ = 0;
};

template <int kWidth>
using Integer = Fixed<kWidth, 0>;

// The exact product, fitted to the format of the result. Of other scalars it is a * b.
template <class Result, class A, class B>
Result product(const A& a, const B& b) {
  return Result(a * b);
}
template <class Result, int kA, int kFractionA, Rounding kRoundingA, Overflow kOverflowA, int kB,
          int kFractionB, Rounding kRoundingB, Overflow kOverflowB>
Result product(const Fixed<kA, kFractionA, kRoundingA, kOverflowA>& a,
               const Fixed<kB, kFractionB, kRoundingB, kOverflowB>& b) {
  static_assert(kA + kB <= kMostFixedBits + 2, "the exact product has at most 64 bits");
  return Result::fitted(a.raw() * b.raw(), kFractionA + kFractionB);
}

// In a function that is a template on its scalar: the scalar of another format. It has the rounding
// and overflow of `Scalar`. Of scalars that are not fixed-point numbers it is `Scalar` itself.
//
//   using Wide = WithFormat<Scalar, 40, 32>;
//   const Wide sum = product<Wide>(a, a) + product<Wide>(b, b);
template <class Scalar, int kWidth, int kFraction>
struct FormatOf {
  using Type = Scalar;
};
template <int kOther, int kOthers, Rounding kRounding, Overflow kOverflow, int kWidth,
          int kFraction>
struct FormatOf<Fixed<kOther, kOthers, kRounding, kOverflow>, kWidth, kFraction> {
  using Type = Fixed<kWidth, kFraction, kRounding, kOverflow>;
};
template <class Scalar, int kWidth, int kFraction>
using WithFormat = typename FormatOf<Scalar, kWidth, kFraction>::Type;

}  // namespace emax

#endif
