#include "host/geometry/exact_predicates.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

#include "grid_point.h"

namespace emax::test {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using RationalPoint = std::array<Rational, 3>;

RationalPoint difference(const Point& p, const Point& q) {
  RationalPoint result;
  for (int k = 0; k < 3; ++k) result[static_cast<std::size_t>(k)] = Rational(p[k]) - Rational(q[k]);
  return result;
}

int rational_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto [u, v, w] = std::array{difference(b, a), difference(c, a), difference(d, a)};
  const Rational determinant = u[0] * (v[1] * w[2] - v[2] * w[1]) -
                               u[1] * (v[0] * w[2] - v[2] * w[0]) +
                               u[2] * (v[0] * w[1] - v[1] * w[0]);
  return determinant.sign();
}

int rational_orient2d(const Point& a, const Point& b, const Point& c) {
  const auto [u, v] = std::array{difference(b, a), difference(c, a)};
  return Rational(u[0] * v[1] - u[1] * v[0]).sign();
}

int double_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double determinant = (b - a).cross(c - a).dot(d - a);
  return (determinant > 0) - (determinant < 0);
}

Point nudged(const Point& p, Random& random) {
  Point q = p;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t way = random.below(3);
    if (way != 0) q[k] = std::nextafter(q[k], way == 1 ? 1e308 : -1e308);
  }
  return q;
}

TEST(ExactPredicates, SignsByDefinition) {
  const Point o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(orient3d(o, x, y, z), 1);
  EXPECT_EQ(orient3d(o, y, x, z), -1);
  EXPECT_EQ(orient3d(o, x, y, {5, 7, 0}), 0);
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orient2d({0, 0}, {1, 1}, {3, 3}), 0);
  EXPECT_TRUE(collinear({1e7, 1, 2}, {1e7 + 1, 2, 3}, {1e7 + 5, 6, 7}));
  EXPECT_FALSE(collinear({1e7, 1, 2}, {1e7 + 1, 2, 3}, {1e7 + 5, 6, 7 + 1e-15 * 8}));
  // Projections keep orientation along every axis.
  for (int axis = 0; axis < 3; ++axis) {
    const Point a = Point::Unit((axis + 1) % 3), b = Point::Unit((axis + 2) % 3);
    EXPECT_EQ(orient2d(project(o, axis), project(a, axis), project(b, axis)), 1);
  }
}

// Points nearly in one plane or on one line, by a last bit here and there, at several distances
// from the origin. The plain double determinant must get some wrong, or these points prove nothing.
TEST(ExactPredicates, AgreeWithRationalsWhereDoublesFail) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  std::array<int, 3> signs3{}, signs2{};
  int wrong_in_double = 0;
  for (int i = 0; i < 6000; ++i) {
    const double offset = i % 3 == 0 ? 0 : i % 3 == 1 ? 100 : 1e7;
    const Point origin = Point::Constant(offset) + random.point(-1, 1);
    const Point a = origin, b = origin + random.point(-1, 1), c = origin + random.point(-1, 1);
    const double s = random.uniform(-1, 2), t = random.uniform(-1, 2);
    const Point d = nudged(a + s * (b - a) + t * (c - a), random);
    const int expected = rational_orient3d(a, b, c, d);
    ASSERT_EQ(orient3d(a, b, c, d), expected) << i;
    ASSERT_EQ(orient3d(b, a, c, d), -expected) << i;
    ++signs3[static_cast<std::size_t>(expected + 1)];
    if (double_orient3d(a, b, c, d) != expected) ++wrong_in_double;

    const Point e = nudged(a + s * (b - a), random);
    const int expected2 = rational_orient2d(a, b, e);
    ASSERT_EQ(orient2d(a.head<2>(), b.head<2>(), e.head<2>()), expected2) << i;
    ++signs2[static_cast<std::size_t>(expected2 + 1)];
  }
  EXPECT_GT(wrong_in_double, 100);
  for (const std::size_t sign : {0u, 2u}) {
    EXPECT_GT(signs3[sign], 1000);
    EXPECT_GT(signs2[sign], 1000);
  }
}

TEST(ExactPredicates, AgreeWithRationalsOnSmallGrids) {
  constexpr std::uint64_t kSeed = 12;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  int coplanar = 0;
  for (int i = 0; i < 5000; ++i) {
    std::array<Point, 4> p;
    // Tenths are not exact in binary: what looks coplanar in decimals may not be.
    for (Point& q : p) q = grid_point(random, 4) / 10;
    const int expected = rational_orient3d(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), expected) << i;
    coplanar += expected == 0;
  }
  EXPECT_GT(coplanar, 200);
}

// The same points so small that products of their differences are subnormal: a filter that believed
// them would err.
TEST(ExactPredicates, AgreeWithRationalsWhereProductsUnderflow) {
  constexpr std::uint64_t kSeed = 15;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  int wrong_in_double = 0;
  for (int i = 0; i < 2000; ++i) {
    // Cubes, or squares, of this size are around the least subnormal, 2^-1074.
    const double scale = std::ldexp(1.0, (i % 2 == 0 ? -355 : -532) - i % 7);
    const Point a = random.point(-1, 1), b = random.point(-1, 1), c = random.point(-1, 1);
    const double s = random.uniform(-1, 2), t = random.uniform(-1, 2);
    const Point d = nudged(a + s * (b - a) + t * (c - a), random);
    const Point e = nudged(a + s * (b - a), random);
    const int expected = rational_orient3d(scale * a, scale * b, scale * c, scale * d);
    ASSERT_EQ(orient3d(scale * a, scale * b, scale * c, scale * d), expected) << i;
    wrong_in_double += double_orient3d(scale * a, scale * b, scale * c, scale * d) != expected;
    const Point p = scale * a, q = scale * b, r = scale * e;
    ASSERT_EQ(orient2d(p.head<2>(), q.head<2>(), r.head<2>()), rational_orient2d(p, q, r)) << i;
  }
  EXPECT_GT(wrong_in_double, 500);
}

// Magnitudes from alike to the whole range of doubles: machine words, wide integers, and a filter
// that over- and underflows.
TEST(ExactPredicates, AgreeWithRationalsAtAllMagnitudes) {
  constexpr std::uint64_t kSeed = 13;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  std::array<int, 3> signs{};
  for (const std::uint32_t spread : {1u, 6u, 12u, 60u, 100u, 120u, 200u, 2090u}) {
    SCOPED_TRACE("spread " + std::to_string(spread));
    const auto any = [&] {
      if (random.below(8) == 0) return 0.0;
      const int exponent =
          static_cast<int>(random.below(spread)) - static_cast<int>(spread / 2) - 25;
      return std::ldexp(random.uniform(-1, 1), exponent);
    };
    for (int i = 0; i < 400; ++i) {
      std::array<Point, 4> p;
      for (Point& q : p) q = Point{any(), any(), any()};
      // Most in the plane of the others, exactly or but for last bits.
      if (i % 4 != 0) {
        p[0] = Point::Zero();
        p[3] = p[1] / 2;
        if (i % 4 == 2) p[3] = nudged(p[3], random);
      }
      const int expected = rational_orient3d(p[0], p[1], p[2], p[3]);
      ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), expected) << i;
      ++signs[static_cast<std::size_t>(expected + 1)];
      ASSERT_EQ(orient2d(p[0].head<2>(), p[1].head<2>(), p[3].head<2>()),
                rational_orient2d(p[0], p[1], p[3]))
          << i;
    }
  }
  for (const int count : signs) EXPECT_GT(count, 300);
  const double least = 5e-324, most = 1.7e308;
  EXPECT_EQ(orient3d({0, 0, 0}, {least, 0, 0}, {0, least, 0}, {0, 0, least}), 1);
  EXPECT_EQ(orient3d({-most, -most, -most}, {most, 0, 0}, {0, most, 0}, {0, 0, least}), 1);
  EXPECT_EQ(rational_orient3d({-most, -most, -most}, {most, 0, 0}, {0, most, 0}, {0, 0, least}), 1);
}

// Whole numbers as far apart as machine words and then the narrow integers allow, and farther.
TEST(ExactPredicates, AgreeWithRationalsAtTheLimitsOfTheIntegers) {
  constexpr std::uint64_t kSeed = 14;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  constexpr std::array kBits{60, 61, 62, 63, 64, 160, 161, 172, 180, 260};
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const double most = std::ldexp(1 - 0x1p-53, kBits[static_cast<std::size_t>(i) % kBits.size()]);
    const std::array<double, 5> values{0, 1, 3, most, most - 0x1p11};
    const auto any = [&] { return values[random.below(5)] * (random.below(2) == 0 ? 1 : -1); };
    std::array<Point, 4> p;
    for (Point& q : p) q = Point{any(), any(), any()};
    const int expected = rational_orient3d(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), expected) << i;
    zeros += expected == 0;
    ASSERT_EQ(orient2d(p[0].head<2>(), p[1].head<2>(), p[2].head<2>()),
              rational_orient2d(p[0], p[1], p[2]))
        << i;
  }
  EXPECT_GT(zeros, 300);
}

}  // namespace
}  // namespace emax::test
