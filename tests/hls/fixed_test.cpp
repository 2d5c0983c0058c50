// Fixed-point numbers beside their definition in wider arithmetic.
#include "hls/kernel/fixed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hls/kernel/point_triangle.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

__extension__ using Int128 = __int128;

// What `exact` units of 2^-fraction are in a format: by division of 128-bit integers, where the
// kernel shifts.
Int128 defined(Int128 exact, int fraction, const FixedFormat& to) {
  const Int128 range = Int128{1} << to.width, half_range = range / 2;
  Int128 scaled = exact;
  int up = to.fraction - fraction;
  for (; up > 0; --up) scaled *= 2;
  Int128 divisor = 1;
  for (; up < 0; ++up) divisor *= 2;
  if (to.rounding == Rounding::kHalfUp) {
    scaled = 2 * scaled + divisor;
    divisor *= 2;
  }
  Int128 rounded = scaled / divisor;
  if (rounded * divisor > scaled) --rounded;
  if (to.overflow == Overflow::kSaturate) {
    return rounded >= half_range ? half_range - 1 : rounded < -half_range ? -half_range : rounded;
  }
  Int128 wrapped = rounded % range;
  if (wrapped >= half_range) wrapped -= range;
  if (wrapped < -half_range) wrapped += range;
  return wrapped;
}

template <class Number>
std::int64_t as_defined(Int128 exact, int fraction) {
  return static_cast<std::int64_t>(defined(exact, fraction, Number::format()));
}

// The operations of a and b whose results are not those of the definition for numbers like Judge.
template <class Judge, class A, class B>
int differences(const A& a, const B& b) {
  constexpr int kA = A::format().fraction, kB = B::format().fraction;
  const Int128 x = a.raw(), y = b.raw();
  const A to_a(b);
  const B to_b(a);
  int wrong = product<A>(a, b).raw() != as_defined<Judge>(x * y, kA + kB);
  wrong += to_a.raw() != as_defined<Judge>(y, kB);
  wrong += A(to_b).raw() != as_defined<Judge>(defined(x, kA, B::format()), kB);
  wrong += (a + to_a).raw() != as_defined<Judge>(x + to_a.raw(), kA);
  wrong += (a - to_a).raw() != as_defined<Judge>(x - to_a.raw(), kA);
  wrong += (a * to_a).raw() != as_defined<Judge>(x * to_a.raw(), 2 * kA);
  wrong += (-a).raw() != as_defined<Judge>(-x, kA);
  wrong += magnitude(a).raw() != as_defined<Judge>(x < 0 ? -x : x, kA);
  wrong += (a < to_a) != (x < to_a.raw()) || (a > to_a) != (x > to_a.raw());
  wrong += (a <= to_a) != (x <= to_a.raw()) || (a >= to_a) != (x >= to_a.raw());
  wrong += (a == to_a) != (x == to_a.raw()) || (a != to_a) != (x != to_a.raw());
  return wrong;
}

template <class Judge, class A, class B>
long differences_of_all() {
  constexpr std::int64_t kLeastA = -1 - fixed_greatest(A::format().width);
  constexpr std::int64_t kLeastB = -1 - fixed_greatest(B::format().width);
  long wrong = 0;
  for (std::int64_t a = kLeastA; a < -kLeastA; ++a) {
    for (std::int64_t b = kLeastB; b < -kLeastB; ++b) {
      wrong += differences<Judge>(A::from_raw(a), B::from_raw(b));
    }
  }
  return wrong;
}

// Numbers of any size, and those near the ends of the format.
template <class Number>
Number drawn(Random& random) {
  const std::int64_t greatest = fixed_greatest(Number::format().width);
  const auto near = static_cast<std::int64_t>(random.below(4));
  if (random.one_in(8))
    return Number::from_raw(random.one_in(2) ? greatest - near : -greatest - 1 + near);
  return Number::from_raw(static_cast<std::int64_t>(random.bits()) >> random.below(64));
}

template <class Judge, class A, class B>
long differences_of_drawn(int pairs) {
  Random random(1);
  long wrong = 0;
  for (int i = 0; i < pairs; ++i) {
    const A a = drawn<A>(random);
    wrong += differences<Judge>(a, drawn<B>(random));
  }
  return wrong;
}

constexpr auto kDown = Rounding::kDown;
constexpr auto kWrap = Overflow::kWrap;

template <class A, class B>
void expect_all_as_defined() {
  EXPECT_EQ((differences_of_all<A, A, B>()), 0);
}

template <class A, class B>
void expect_drawn_as_defined() {
  EXPECT_EQ((differences_of_drawn<A, A, B>(100000)), 0);
}

TEST(Fixed, EveryPairOfSmallNumbersIsAsDefined) {
  expect_all_as_defined<Fixed<6, 3>, Fixed<5, 1>>();
  expect_all_as_defined<Fixed<6, 3, kDown>, Fixed<5, 4>>();
  expect_all_as_defined<Fixed<6, 5, Rounding::kHalfUp, kWrap>, Fixed<7, 2>>();
  expect_all_as_defined<Fixed<6, 0, kDown, kWrap>, Fixed<6, 5>>();
  expect_all_as_defined<Integer<2>, Integer<7>>();
}

TEST(Fixed, DrawnPairsOfWideNumbersAreAsDefined) {
  expect_drawn_as_defined<Fixed<18, 16>, Fixed<36, 32>>();
  expect_drawn_as_defined<Fixed<18, 16, kDown, kWrap>, Fixed<24, 3>>();
  expect_drawn_as_defined<Fixed<32, 31>, Fixed<32, 0>>();
  expect_drawn_as_defined<Fixed<32, 20, kDown>, Fixed<32, 31, kDown, kWrap>>();
  expect_drawn_as_defined<Fixed<20, 10>, Fixed<44, 43>>();
}

TEST(FixedFault, AnotherRoundingOrOverflowIsNoticed) {
  EXPECT_GT((differences_of_all<Fixed<6, 3, kDown>, Fixed<6, 3>, Fixed<5, 1>>()), 0);
  EXPECT_GT((differences_of_all<Fixed<6, 3, Rounding::kHalfUp, kWrap>, Fixed<6, 3>, Fixed<5, 1>>()),
            0);
  EXPECT_GT((differences_of_drawn<Fixed<18, 16, kDown>, Fixed<18, 16>, Fixed<36, 32>>(1000)), 0);
}

TEST(Fixed, WidestSumsDoNotOverflow) {
  using Widest = Fixed<kMostFixedBits, 0>;
  using Wrapping = Fixed<kMostFixedBits, 0, kDown, kWrap>;
  const std::int64_t greatest = fixed_greatest(kMostFixedBits);
  const Widest most = Widest::from_raw(greatest), least = Widest::from_raw(-greatest - 1);
  EXPECT_EQ(most + most, most);
  EXPECT_EQ(least + least, least);
  EXPECT_EQ(least - most, least);
  EXPECT_EQ(-least, most);
  EXPECT_EQ(magnitude(least), most);
  EXPECT_EQ(-Wrapping::from_raw(-greatest - 1), Wrapping::from_raw(-greatest - 1));
  EXPECT_EQ((Fixed<62, 61>(Integer<4>(-1.0))).raw(), -greatest - 1);
  EXPECT_EQ((Fixed<62, 61>(Integer<4>(1.0))).raw(), greatest);
}

TEST(Fixed, ConstantsAreTheNearestNumbers) {
  using Number = Fixed<8, 4>;
  for (int eighths = -80; eighths <= 80; ++eighths) {
    const Int128 exact = defined(eighths, 3, Number::format());
    EXPECT_EQ(Number(eighths / 8.0).raw(), static_cast<std::int64_t>(exact)) << eighths;
  }
  EXPECT_EQ(Number(0.03125).raw(), 1);  // half a unit
  EXPECT_EQ(Number(-0.03125).raw(), 0);
  EXPECT_EQ(Number(std::nextafter(0.03125, 0)).raw(), 0);
  EXPECT_EQ(Number(7.97).raw(), 127);
  EXPECT_EQ(Number(1e300).raw(), 127);
  EXPECT_EQ(Number(-std::numeric_limits<double>::infinity()).raw(), -128);
  EXPECT_EQ(Number(std::numeric_limits<double>::quiet_NaN()).raw(), 0);
  EXPECT_EQ((Fixed<62, 0>(0x1p61).raw()), fixed_greatest(62));
  EXPECT_EQ((Fixed<62, 0>(0x1.fffffffffffffp60).raw()), 0x1fffffffffffff00);
  EXPECT_EQ(static_cast<double>(Number(-1.5)), -1.5);
}

// The distance of a point above a right triangle, in 18 bits and in reals.
TEST(Fixed, KernelRunsOnFixedPointNumbers) {
  using Number = Fixed<18, 16>;
  const auto distance = [](auto zero) {
    using Scalar = decltype(zero);
    const Scalar half(0.5), one(1.0), diagonal(0.70710678118);
    const TriangleRecord<Scalar> record{{zero, zero, zero},
                                        {one, zero, zero},
                                        {zero, one, zero},
                                        {zero, zero, one},
                                        one,
                                        {{one, zero}, half},
                                        {{half, -diagonal}, one},
                                        0};
    return squared_distance(record, false, Vector3<Scalar>{half, -half, half});
  };
  EXPECT_EQ(static_cast<double>(distance(Number())), distance(0.0));
}

TEST(Fixed, FormatFollowsTheScalar) {
  using Wrapping = Fixed<18, 16, kDown, kWrap>;
  EXPECT_TRUE((std::is_same_v<WithFormat<Wrapping, 40, 32>, Fixed<40, 32, kDown, kWrap>>));
  EXPECT_TRUE((std::is_same_v<WithFormat<float, 40, 32>, float>));
  EXPECT_EQ(product<float>(1.5f, 2.0f), 3.0f);
  EXPECT_EQ(sizeof(TriangleRecord<Wrapping>), 4 * kRecordWords);
}

}  // namespace
}  // namespace emax
