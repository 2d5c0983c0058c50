#include "testbench/operators/operator_reference.h"

#include <cmath>
#include <limits>

#include "sw_model/base/float_bits.h"
#include "sw_model/base/flush_mode.h"

namespace emax {
namespace {

std::uint32_t word_of(float value) {
  const std::uint32_t bits = float_bits(value);
  return is_nan_bits(bits) ? kCanonicalNan : bits;
}

}  // namespace

void host_results(std::span<const OperandPair> pairs, std::span<OperatorResults> results) {
  const ScopedFlushMode flush;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const float a = bits_float(pairs[i].a), b = bits_float(pairs[i].b);
    results[i] = {{word_of(a + b), word_of(a - b), word_of(a * b), word_of(a * a), a < b}};
  }
}

double SmallFormat::value(std::uint32_t word) const {
  const std::uint32_t ones = (1u << exponent) - 1;
  const std::uint32_t held = word >> fraction & ones;
  const std::uint32_t low = word & ((1u << fraction) - 1);
  double magnitude = 0;
  if (held == ones) {
    magnitude = low != 0 ? std::numeric_limits<double>::quiet_NaN()
                         : std::numeric_limits<double>::infinity();
  } else if (held != 0) {
    const int bias = (1 << (exponent - 1)) - 1;
    magnitude = std::ldexp(static_cast<double>((1u << fraction) + low),
                           static_cast<int>(held) - bias - fraction);
  }
  return (word >> (width() - 1) & 1u) != 0 ? -magnitude : magnitude;
}

std::uint32_t SmallFormat::rounded(double exact) const {
  const std::uint32_t ones = (1u << exponent) - 1;
  const std::uint32_t infinity = ones << fraction;
  if (std::isnan(exact)) return infinity | 1u << (fraction - 1);
  const std::uint32_t sign = std::signbit(exact) ? 1u << (width() - 1) : 0;
  if (std::isinf(exact)) return sign | infinity;
  const double magnitude = std::fabs(exact);
  const int bias = (1 << (exponent - 1)) - 1;
  const double smallest = std::ldexp(1.0, 1 - bias);
  if (magnitude < smallest * (1 - std::ldexp(1.0, -fraction - 2))) return sign;

  int binade = 0;  // magnitude is in [2^binade, 2^(binade + 1)); at least that of the smallest
  std::frexp(magnitude, &binade);
  binade = std::max(binade - 1, -bias);
  const double scaled = std::ldexp(magnitude, fraction - binade);
  double whole = std::floor(scaled);
  const double rest = scaled - whole;
  if (rest > 0.5 || (rest == 0.5 && std::fmod(whole, 2) != 0)) whole += 1;
  const auto units = static_cast<std::uint32_t>(whole);
  // A carry out of the fraction increments the exponent, up to infinity.
  const std::uint32_t word =
      (static_cast<std::uint32_t>(binade + bias) << fraction) + (units - (1u << fraction));
  return sign | std::min(word, infinity);
}

OperatorResults SmallFormat::results(OperandPair pair) const {
  const double a = value(pair.a), b = value(pair.b);
  return {{rounded(a + b), rounded(a - b), rounded(a * b), rounded(a * a), a < b}};
}

}  // namespace emax
