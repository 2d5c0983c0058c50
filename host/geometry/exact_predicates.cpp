#include "host/geometry/exact_predicates.h"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace emax {
namespace {

namespace mp = boost::multiprecision;

template <unsigned kBits>
using Fixed =
    mp::number<mp::cpp_int_backend<kBits, kBits, mp::signed_magnitude, mp::unchecked, void>>;

// Largest spans, in bits from the lowest to the highest of the coordinates along one axis.
// kWordSpan: machine integers suffice. kNarrowSpan: nearly all meshes. kWidestSpan: any doubles.
// The integers hold the determinant of three differences, each of which has one bit more.
constexpr int kWordSpan = 60;
constexpr int kNarrowSpan = 160;
constexpr int kWidestSpan = 1024 + 1074;
using Narrow = Fixed<512>;
using Wide = Fixed<6336>;
static_assert(2 * (kWordSpan + 1) + 2 + 3 <= 127);
static_assert(3 * (kNarrowSpan + 1) + 3 <= 512);
static_assert(3 * (kWidestSpan + 1) + 3 <= 6336);

__extension__ using Int128 = __int128;

// Coordinates along one axis as integers. Each axis has its own unit, a power of two, which scales
// a determinant without changing its sign.
template <std::size_t N>
class Axis {
 public:
  explicit Axis(const std::array<double, N>& values) {
    int lowest = std::numeric_limits<int>::max();
    int highest = std::numeric_limits<int>::min();
    for (std::size_t i = 0; i < N; ++i) {
      constexpr std::uint64_t kLeadingBit = std::uint64_t{1} << 52;
      const auto bits = std::bit_cast<std::uint64_t>(values[i]);
      const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
      std::uint64_t magnitude = (bits & (kLeadingBit - 1)) | (exponent == 0 ? 0 : kLeadingBit);
      if (magnitude == 0) continue;
      const int zeros = std::countr_zero(magnitude);
      magnitude >>= zeros;
      shift_[i] = std::max(exponent, 1) + zeros;
      negative_[i] = std::signbit(values[i]);
      magnitude_[i] = magnitude;
      lowest = std::min(lowest, shift_[i]);
      highest = std::max(highest, shift_[i] + static_cast<int>(std::bit_width(magnitude)));
    }
    if (highest < lowest) return;  // all are zero
    span_ = highest - lowest;
    for (std::size_t i = 0; i < N; ++i) {
      if (magnitude_[i] != 0) shift_[i] -= lowest;
    }
  }

  int span() const { return span_; }

  template <class Integer>
  Integer integer(std::size_t i) const {
    auto magnitude = static_cast<Integer>(magnitude_[i]);
    magnitude <<= shift_[i];
    return negative_[i] ? Integer(-magnitude) : magnitude;
  }

  // values[i] - values[0]
  template <class Integer>
  Integer difference(std::size_t i) const {
    return integer<Integer>(i) - integer<Integer>(0);
  }

 private:
  std::array<std::uint64_t, N> magnitude_{};
  std::array<int, N> shift_{};
  std::array<bool, N> negative_{};
  int span_ = 0;
};

template <class Integer>
int sign(const Integer& value) {
  return (value > 0) - (value < 0);
}

template <class Difference, class Product>
int sign2d(const Axis<3>& x, const Axis<3>& y) {
  const auto dx = [&](std::size_t i) { return Product(x.template difference<Difference>(i)); };
  const auto dy = [&](std::size_t i) { return Product(y.template difference<Difference>(i)); };
  return sign(Product(dx(1) * dy(2) - dy(1) * dx(2)));
}

// The sign of a[0] b[0] + a[1] b[1] + a[2] b[2]. In words |a| < 2^61 and |b| < 2^124: b is split at
// 64 bits, so that both sums fit into 128 bits.
int sign_of_sum(const std::array<std::int64_t, 3>& a, const std::array<Int128, 3>& b) {
  Int128 upper = 0;
  Int128 lower = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    upper += a[i] * (b[i] >> 64);
    lower += Int128{a[i]} * static_cast<std::uint64_t>(b[i]);
  }
  upper += lower >> 64;
  return upper != 0 ? sign(upper) : static_cast<std::uint64_t>(lower) != 0;
}

template <class Integer>
int sign_of_sum(const std::array<Integer, 3>& a, const std::array<Integer, 3>& b) {
  return sign(Integer(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
}

template <class Difference, class Product>
int sign3d(const std::array<Axis<4>, 3>& axis) {
  std::array<Difference, 3> w;
  std::array<Product, 3> minor;
  for (std::size_t k = 0; k < 3; ++k) {
    const Axis<4>& next = axis[(k + 1) % 3];
    const Axis<4>& last = axis[(k + 2) % 3];
    const auto d = [](const Axis<4>& along, std::size_t i) {
      return Product(along.template difference<Difference>(i));
    };
    minor[k] = d(next, 1) * d(last, 2) - d(last, 1) * d(next, 2);
    w[k] = axis[k].template difference<Difference>(3);
  }
  return sign_of_sum(w, minor);
}

// If the greatest differences are between these limits, no product of three of them over- or
// underflows by as much as the slack in the error bounds below.
constexpr double kSmallest = 1e-90;
constexpr double kGreatest = 1e90;

}  // namespace

int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a;
  const Eigen::Vector2d v = c - a;
  const double x = std::max(std::abs(u[0]), std::abs(v[0]));
  const double y = std::max(std::abs(u[1]), std::abs(v[1]));
  if (x == 0 || y == 0) return 0;
  if (std::min(x, y) > kSmallest && std::max(x, y) < kGreatest) {
    // In units of 2^-53 x y: differences 2 for each of two products, products 1 each, their
    // difference 2; together 8, and 9 leaves room for terms of second order.
    const double bound = 9 * 0x1p-53 * x * y;
    const double determinant = u[0] * v[1] - u[1] * v[0];
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
  }
  const Axis<3> along_x({a[0], b[0], c[0]});
  const Axis<3> along_y({a[1], b[1], c[1]});
  const int span = std::max(along_x.span(), along_y.span());
  if (span <= kWordSpan) return sign2d<std::int64_t, Int128>(along_x, along_y);
  if (span <= kNarrowSpan) return sign2d<Narrow, Narrow>(along_x, along_y);
  return sign2d<Wide, Wide>(along_x, along_y);
}

int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Point u = b - a;
  const Point v = c - a;
  const Point w = d - a;
  const Point greatest = u.cwiseAbs().cwiseMax(v.cwiseAbs()).cwiseMax(w.cwiseAbs());
  const double least_axis = greatest.minCoeff();
  if (least_axis == 0) return 0;
  if (least_axis > kSmallest && greatest.maxCoeff() < kGreatest) {
    // In units of 2^-53 x y z: differences 3 and products 1 for each of six products, their three
    // differences 2 each, the multiplications by w 2 each, the sums 4 and 6; together 46, and 48
    // leaves room for terms of second order.
    const double bound = 48 * 0x1p-53 * greatest[0] * greatest[1] * greatest[2];
    const double determinant = w[0] * (u[1] * v[2] - u[2] * v[1]) +
                               w[1] * (u[2] * v[0] - u[0] * v[2]) +
                               w[2] * (u[0] * v[1] - u[1] * v[0]);
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
  }
  const auto along = [&](int k) { return Axis<4>({a[k], b[k], c[k], d[k]}); };
  const std::array<Axis<4>, 3> axis{along(0), along(1), along(2)};
  const int span = std::max({axis[0].span(), axis[1].span(), axis[2].span()});
  if (span <= kWordSpan) return sign3d<std::int64_t, Int128>(axis);
  if (span <= kNarrowSpan) return sign3d<Narrow, Narrow>(axis);
  return sign3d<Wide, Wide>(axis);
}

bool collinear(const Point& a, const Point& b, const Point& c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orient2d(project(a, axis), project(b, axis), project(c, axis)) != 0) return false;
  }
  return true;
}

}  // namespace emax
