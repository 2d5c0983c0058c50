// Binary floating-point numbers of any format that the operators of hls/rtl take:
//
//   Binary<5, 10> a(0.75), b(-1.5);  // binary16: 5 bits of exponent, 10 stored bits of the
//   mantissa Binary<8, 7> c(0.75);            // bfloat16 a + b, a - b, a * b, a / b,
//   square_root(a), -a, magnitude(a), a < b, select(a < b, a, b)
//
// A number of 1 + kExponent + kMantissa bits is laid out as in IEEE 754: sign, exponent with a bias
// of 2^(kExponent - 1) - 1, fraction. The greatest exponent is that of infinity and NaN. The
// arithmetic is that of docs/numerics.md in this format, bit for bit that of the modules fp_*:
//   rounding    each operation by itself, to nearest, ties to even
//   subnormals  an operand counts as zero of its sign. A result becomes zero of its sign when it is
//               tiny after rounding at unbounded exponent, that is below the least normal number
//               times 1 - 2^-(kMantissa + 2)
//   NaN         the one of positive sign with the first bit of the fraction alone
// Negation and magnitude change the sign of any bits and nothing else.
//
// Each operation is computed in binary64 and rounded once more. That gives the bits of one rounding
// because binary64 has 53 >= 2 (kMantissa + 1) + 2 digits (Figueroa 1995), and no result of these
// formats leaves its range of normal numbers.
#ifndef EMAX_HLS_KERNEL_BINARY_H
#define EMAX_HLS_KERNEL_BINARY_H

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "hls/kernel/scalar.h"

namespace emax {

struct BinaryFormat {
  int exponent;  // bits
  int mantissa;  // stored bits, without the leading one

  constexpr int width() const { return 1 + exponent + mantissa; }
  constexpr int bias() const { return (1 << (exponent - 1)) - 1; }
  constexpr std::uint64_t sign() const { return std::uint64_t{1} << (exponent + mantissa); }
  constexpr std::uint64_t least_normal() const { return std::uint64_t{1} << mantissa; }
  constexpr std::uint64_t infinity() const { return sign() - least_normal(); }
  constexpr std::uint64_t nan() const { return infinity() | least_normal() >> 1; }
  constexpr std::uint64_t one() const { return static_cast<std::uint64_t>(bias()) << mantissa; }
};

// binary64 has the range for 10 bits of exponent. The multipliers of the families take mantissas of
// 24 bits, and the adder's shift has to fit into the exponent.
constexpr int kLeastExponentBits = 3, kMostExponentBits = 10;
constexpr int kLeastMantissaBits = 2, kMostMantissaBits = 23;
constexpr bool operators_take(const BinaryFormat& format) {
  return format.exponent >= kLeastExponentBits && format.exponent <= kMostExponentBits &&
         format.mantissa >= kLeastMantissaBits && format.mantissa <= kMostMantissaBits &&
         format.mantissa + 4 <= (1 << format.exponent);
}

constexpr BinaryFormat binary64() { return {11, 52}; }

inline std::uint64_t binary64_bits(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}
inline double binary64_value(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// The number that the operators take the bits for; subnormal ones are zero.
inline double binary_value(std::uint64_t bits, const BinaryFormat& format) {
  const std::uint64_t fields = bits & (format.sign() - 1);
  const std::uint64_t sign = (bits & format.sign()) != 0 ? binary64().sign() : 0;
  std::uint64_t wide = fields << (binary64().mantissa - format.mantissa);
  if (fields < format.least_normal()) {
    wide = 0;
  } else if (fields >= format.infinity()) {
    wide |= binary64().infinity();
  } else {
    wide += static_cast<std::uint64_t>(binary64().bias() - format.bias()) << binary64().mantissa;
  }
  return binary64_value(sign | wide);
}

// The bits of a result that is `exact`, or whose rounding to binary64 it is.
inline std::uint64_t binary_rounded(double exact, const BinaryFormat& format) {
  const std::uint64_t bits = binary64_bits(exact), fields = bits & (binary64().sign() - 1);
  if (fields > binary64().infinity()) return format.nan();
  const std::uint64_t sign = bits != fields ? format.sign() : 0;
  // Half a unit, less one where the last place is even; the carry runs through the exponent.
  const int dropped = binary64().mantissa - format.mantissa;
  const std::uint64_t half = std::uint64_t{1} << (dropped - 1);
  const std::uint64_t rounded = (fields + half - 1 + (fields >> dropped & 1)) >> dropped;
  const std::uint64_t zero = static_cast<std::uint64_t>(binary64().bias() - format.bias())
                             << format.mantissa;
  if (rounded < zero + format.least_normal()) return sign;
  const std::uint64_t result = rounded - zero;
  return sign | (result < format.infinity() ? result : format.infinity());
}

// The bits of a constant, as a conversion to float makes them of a double: the nearest number, ties
// to even, subnormal ones among them; of a NaN its sign and the upper bits of its fraction.
inline std::uint64_t binary_constant(double value, const BinaryFormat& format) {
  const std::uint64_t bits = binary64_bits(value), fields = bits & (binary64().sign() - 1);
  const std::uint64_t sign = bits != fields ? format.sign() : 0;
  const int dropped = binary64().mantissa - format.mantissa;
  if (fields > binary64().infinity()) {
    const std::uint64_t fraction = fields & (binary64().least_normal() - 1);
    return sign | format.nan() | fraction >> dropped;
  }
  const auto least_normal = static_cast<std::uint64_t>(binary64().bias() - format.bias() + 1);
  if (fields >= least_normal << binary64().mantissa) return binary_rounded(value, format);
  // The last place of this power of two is the least subnormal number.
  const std::uint64_t power = (least_normal + static_cast<std::uint64_t>(dropped))
                              << binary64().mantissa;
  return sign | (binary64_bits(binary64_value(power) + binary64_value(fields)) - power);
}

template <int kExponent, int kMantissa>
class Binary {
  static_assert(operators_take(BinaryFormat{kExponent, kMantissa}),
                "a binary format has 3 to 10 bits of exponent and 2 to 23 stored bits of mantissa, "
                "at most 2^exponent - 4");

 public:
  using Raw = std::conditional_t<(1 + kExponent + kMantissa <= 32), std::uint32_t, std::uint64_t>;

  static constexpr BinaryFormat format() { return {kExponent, kMantissa}; }

  Binary() = default;
  explicit Binary(double constant) : Binary(from_bits(binary_constant(constant, format()))) {}

  // The lowest bits of `bits` count.
  static Binary from_bits(std::uint64_t bits) {
    Binary number;
    number.bits_ = static_cast<Raw>(bits & (2 * format().sign() - 1));
    return number;
  }
  std::uint64_t bits() const { return bits_; }

  // What it counts as: a subnormal number is zero.
  explicit operator double() const { return binary_value(bits_, format()); }

  friend Binary operator+(const Binary& a, const Binary& b) {
    return rounded(a.value() + b.value());
  }
  friend Binary operator-(const Binary& a, const Binary& b) {
    return rounded(a.value() - b.value());
  }
  friend Binary operator*(const Binary& a, const Binary& b) {
    return rounded(a.value() * b.value());
  }
  friend Binary operator/(const Binary& a, const Binary& b) {
    return rounded(a.value() / b.value());
  }
  friend Binary square_root(const Binary& a) { return rounded(std::sqrt(a.value())); }
  friend Binary operator-(const Binary& a) { return from_bits(a.bits() ^ format().sign()); }
  friend Binary magnitude(const Binary& a) { return from_bits(a.bits() & (format().sign() - 1)); }

  friend bool operator<(const Binary& a, const Binary& b) { return a.value() < b.value(); }
  friend bool operator>(const Binary& a, const Binary& b) { return a.value() > b.value(); }
  friend bool operator<=(const Binary& a, const Binary& b) { return a.value() <= b.value(); }
  friend bool operator>=(const Binary& a, const Binary& b) { return a.value() >= b.value(); }
  friend bool operator==(const Binary& a, const Binary& b) { return a.value() == b.value(); }
  friend bool operator!=(const Binary& a, const Binary& b) { return a.value() != b.value(); }

  friend Binary select(bool condition, const Binary& if_true, const Binary& if_false) {
    return condition ? if_true : if_false;
  }

 private:
  static Binary rounded(double exact) { return from_bits(binary_rounded(exact, format())); }
  double value() const { return binary_value(bits_, format()); }

  Raw bits_ = 0;
};

}  // namespace emax

#endif
