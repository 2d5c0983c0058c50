// Binary numbers of any format beside their definition: an exact result, rounded once by the
// reference of the operators (testbench/operators/operator_reference.h).
#include "hls/kernel/binary.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "sw_model/base/float_bits.h"
#include "sw_model/model/flushed_float.h"
#include "testbench/operators/operator_reference.h"
#include "testbench/stimuli/random.h"
#include "testbench/stimuli/words.h"

namespace emax {
namespace {

using Half = Binary<5, 10>;
using Brain = Binary<8, 7>;

// Stands for an exact result where it is rounded to fewer digits than binary64 has, less two: the
// result itself or, of the two doubles around it, the one whose last digit is odd. `nearest` is the
// nearest double, `rest` has the sign of the exact result less `nearest`.
double rounded_to_odd(double nearest, double rest) {
  const bool is_exact = rest == 0 || nearest == 0 || !std::isfinite(nearest);
  if (is_exact || (std::bit_cast<std::uint64_t>(nearest) & 1u) != 0) return nearest;
  return std::nextafter(nearest, std::copysign(std::numeric_limits<double>::infinity(), rest));
}

double exact_sum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return rounded_to_odd(sum, (a - (sum - of_b)) + (b - of_b));  // Knuth's TwoSum
}

double exact_quotient(double a, double b) {
  const double quotient = a / b, rest = std::fma(-quotient, b, a);
  return rounded_to_odd(quotient, b < 0 ? -rest : rest);
}

double exact_root(double a) {
  const double root = std::sqrt(a);
  return rounded_to_odd(root, std::fma(-root, root, a));
}

template <class Number>
SmallFormat reference_of() {
  return {Number::format().exponent, Number::format().mantissa};
}

// The operations of a and b whose results are not those of `judge`. Products are exact in double.
template <class Number>
int differences_from(const SmallFormat& judge, const Number& a, const Number& b) {
  const auto word_a = static_cast<std::uint32_t>(a.bits());
  const std::uint32_t sign = 1u << (judge.width() - 1);
  const double x = judge.value(word_a), y = judge.value(static_cast<std::uint32_t>(b.bits()));
  const auto is = [&](const Number& given, double exact) {
    return given.bits() == judge.rounded(exact);
  };
  int wrong = !is(a + b, exact_sum(x, y)) + !is(a - b, exact_sum(x, -y));
  wrong += !is(a * b, x * y) + !is(a * a, x * x);
  wrong += !is(a / b, exact_quotient(x, y)) + !is(square_root(a), exact_root(x));
  wrong += (-a).bits() != (word_a ^ sign) || magnitude(a).bits() != (word_a & ~sign);
  wrong += (a < b) != (x < y) || (a > b) != (x > y);
  wrong += (a <= b) != (x <= y) || (a >= b) != (x >= y);
  wrong += (a == b) != (x == y) || (a != b) != (x != y);
  wrong += select(a < b, a, b).bits() != (x < y ? a.bits() : b.bits());
  return wrong;
}

template <class Number>
long differences_of_all_pairs(const SmallFormat& judge = reference_of<Number>()) {
  const std::uint64_t end = 2 * Number::format().sign();
  long wrong = 0;
  for (std::uint64_t a = 0; a < end; ++a) {
    for (std::uint64_t b = 0; b < end; ++b) {
      wrong += differences_from(judge, Number::from_bits(a), Number::from_bits(b));
    }
  }
  return wrong;
}

// Words of every kind: at and beside the ends of the kinds of numbers, any, of few ones.
std::uint64_t drawn_word(Random& random, const BinaryFormat& format) {
  const std::uint64_t ends[] = {0, format.least_normal(), format.one(), format.infinity(),
                                format.nan()};
  const std::uint64_t end = ends[random.below(5)];
  const std::uint64_t any = random.bits(), few = any & random.bits() & random.bits();
  const std::uint64_t fraction = format.least_normal() - 1;
  switch (random.below(4)) {
    case 0:
      return (end + random.below(5) - 2) ^ (any & format.sign());
    case 1:
      return (any & ~fraction) | (few & fraction);
    default:
      return any;
  }
}

// A second word: any, a neighbour of the first, or one whose product or quotient with it is near
// the least normal number.
std::uint64_t drawn_partner(Random& random, const BinaryFormat& format, std::uint64_t first) {
  const std::uint64_t any = drawn_word(random, format);
  const std::uint64_t one = format.one(), exponents = first & format.infinity();
  const std::uint64_t fraction = any & (format.least_normal() - 1);
  switch (random.below(4)) {
    case 0:
      return (first + random.below(9) - 4) ^ (any & format.sign());
    case 1:
      return (one - exponents + random.below(3) * format.least_normal()) | fraction;
    case 2:
      return (exponents + one - random.below(3) * format.least_normal()) | fraction;
    default:
      return any;
  }
}

template <class Number>
long differences_of_drawn_pairs(int pairs, const SmallFormat& judge = reference_of<Number>()) {
  Random random(named_seed("binary numbers", 1));
  long wrong = 0;
  for (int i = 0; i < pairs; ++i) {
    const std::uint64_t a = drawn_word(random, Number::format());
    const std::uint64_t b = drawn_partner(random, Number::format(), a);
    wrong += differences_from(judge, Number::from_bits(a), Number::from_bits(b));
  }
  return wrong;
}

TEST(Binary, EveryPairOfSmallNumbersIsAsDefined) {
  EXPECT_EQ((differences_of_all_pairs<Binary<4, 3>>()), 0);
  EXPECT_EQ((differences_of_all_pairs<Binary<5, 2>>()), 0);
  EXPECT_EQ((differences_of_all_pairs<Binary<3, 4>>()), 0);
}

TEST(Binary, DrawnPairsAreAsDefined) {
  EXPECT_EQ((differences_of_drawn_pairs<Half>(400000)), 0);
  EXPECT_EQ((differences_of_drawn_pairs<Brain>(400000)), 0);
  EXPECT_EQ((differences_of_drawn_pairs<Binary<8, 23>>(200000)), 0);
  EXPECT_EQ((differences_of_drawn_pairs<Binary<10, 21>>(200000)), 0);
  EXPECT_EQ((differences_of_drawn_pairs<Binary<4, 12>>(200000)), 0);
  EXPECT_EQ((differences_of_drawn_pairs<Binary<5, 23>>(200000)), 0);
}

TEST(BinaryFault, AnotherFormatIsNoticed) {
  EXPECT_GT((differences_of_all_pairs<Binary<4, 3>>(SmallFormat{5, 2})), 0);
  EXPECT_GT((differences_of_drawn_pairs<Half>(1000, SmallFormat{6, 9})), 0);
}

// Every pair of fractions with products and quotients within a factor of two of the least normal
// number. Products that round up to it are not zero; a flush before the rounding would make them
// so.
template <class Number>
void expect_border_as_defined() {
  constexpr BinaryFormat kFormat = Number::format();
  const SmallFormat judge = reference_of<Number>();
  const double least = judge.value(static_cast<std::uint32_t>(kFormat.least_normal()));
  long wrong = 0, rounded_up = 0;
  for (std::uint64_t a = 0; a < kFormat.least_normal(); ++a) {
    for (std::uint64_t b = 0; b < kFormat.least_normal(); ++b) {
      const Number small = Number::from_bits(kFormat.least_normal() | a);
      const Number below_one = Number::from_bits(kFormat.one() - kFormat.least_normal() + b);
      const Number above_one = Number::from_bits(kFormat.one() + b);
      const double exact = static_cast<double>(small) * static_cast<double>(below_one);
      wrong += (small * below_one).bits() != judge.rounded(exact);
      rounded_up += exact < least && (small * below_one).bits() == kFormat.least_normal();
      const double quotient =
          exact_quotient(static_cast<double>(small), static_cast<double>(above_one));
      wrong += (small / above_one).bits() != judge.rounded(quotient);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(rounded_up, 0);
}

TEST(Binary, BorderOfTheLeastNormalNumberIsAsDefined) {
  expect_border_as_defined<Half>();
  expect_border_as_defined<Brain>();
  EXPECT_EQ((Binary<8, 23>::from_bits(0x3f7fffff) * Binary<8, 23>::from_bits(0x00800000)).bits(),
            0u);  // the test vector of docs/numerics.md
}

TEST(Binary, Binary32IsTheModelsScalar) {
  using Single = Binary<8, 23>;
  Random random(named_seed("Binary32IsTheModelsScalar", 1));
  long wrong = 0;
  for (int i = 0; i < 300000; ++i) {
    const std::uint32_t a = any_word(random), b = any_word(random);
    const Single x = Single::from_bits(a), y = Single::from_bits(b);
    const FlushedFloat u(bits_float(a)), v(bits_float(b));
    wrong += (x + y).bits() != to_word(u + v) || (x - y).bits() != to_word(u - v);
    wrong += (x * y).bits() != to_word(u * v) || (x / y).bits() != to_word(u / v);
    wrong += square_root(x).bits() != to_word(square_root(u)) || (-x).bits() != to_word(-u);
    wrong += magnitude(x).bits() != to_word(magnitude(u)) || (x < y) != (u < v);
    const double constant = std::ldexp(random.uniform(-2, 2), i % 300 - 150);
    wrong += Single(constant).bits() != float_bits(static_cast<float>(constant));
    const volatile double wide = bits_float(a);
    wrong += Single(wide).bits() != float_bits(static_cast<float>(wide));
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Binary, ConstantsAreTheNearestNumbers) {
  EXPECT_EQ(Half(1.0).bits(), 0x3c00u);
  EXPECT_EQ(Half(-0.1).bits(), 0xae66u);
  EXPECT_EQ(Half(65519.99).bits(), 0x7bffu);
  EXPECT_EQ(Half(65520.0).bits(), 0x7c00u);
  EXPECT_EQ(Half(-1e300).bits(), 0xfc00u);
  EXPECT_EQ(Half(0x1p-24).bits(), 1u);    // the least subnormal number
  EXPECT_EQ(Half(0x1p-25).bits(), 0u);    // half of it: the tie goes to even
  EXPECT_EQ(Half(0x1.8p-24).bits(), 2u);  // likewise
  EXPECT_EQ(Half(0x1.fffp-15).bits(), 0x0400u);
  EXPECT_EQ(Half(-0.0).bits(), 0x8000u);
  EXPECT_EQ(Half(std::numeric_limits<double>::denorm_min()).bits(), 0u);
  EXPECT_EQ(Half(std::numeric_limits<double>::quiet_NaN()).bits(), 0x7e00u);
  EXPECT_EQ(Brain(0.1).bits(), 0x3dcdu);
  EXPECT_EQ(static_cast<double>(Half(0.1)), 0x1.998p-4);
  EXPECT_EQ(static_cast<double>(Half(0x1p-24)), 0.0);
  EXPECT_EQ((Half(0x1p-24) + Half(0.0)).bits(), 0u);
}

TEST(Binary, FormatsAreThoseOfTheOperators) {
  constexpr BinaryFormat kTaken[] = {{3, 2}, {3, 4}, {5, 10}, {8, 7}, {8, 23}, {10, 23}};
  constexpr BinaryFormat kRefused[] = {{2, 2}, {3, 5}, {11, 10}, {8, 1}, {8, 24}};
  for (const BinaryFormat& format : kTaken) {
    EXPECT_TRUE(operators_take(format)) << format.exponent << ' ' << format.mantissa;
  }
  for (const BinaryFormat& format : kRefused) {
    EXPECT_FALSE(operators_take(format)) << format.exponent << ' ' << format.mantissa;
  }
}

}  // namespace
}  // namespace emax
