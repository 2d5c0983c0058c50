#include "sw_model/certify/matrix_free.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hls/kernel/point_triangle.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "tests/support/long_double_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using Corners = std::array<Point, 3>;

struct Sample {
  Corners corners;
  Point p;
};

// Triangles whose angles are all above about three degrees: what these forms are good at.
Sample well_shaped(test::Random& random) {
  for (;;) {
    const Corners c = {random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
    const TriangleFrame frame = make_frame(c);
    if (frame.v3.y < 0.05 * frame.record.length12 ||
        frame.record.edge13.length < 0.05 * frame.record.length12 ||
        frame.record.edge23.length < 0.05 * frame.record.length12) {
      continue;
    }
    return {c, random.point(-2, 2)};
  }
}

template <class Scalar>
using Form = Scalar (*)(const Eigen::Matrix<Scalar, 3, 1>&, const Eigen::Matrix<Scalar, 3, 1>&,
                        const Eigen::Matrix<Scalar, 3, 1>&, const Eigen::Matrix<Scalar, 3, 1>&);

template <class Scalar>
double greatest_error(Form<Scalar> form, std::uint64_t seed) {
  test::Random random(seed);
  double greatest = 0;
  for (int i = 0; i < 100000; ++i) {
    Sample s = well_shaped(random);
    for (Point& c : s.corners) c = c.cast<Scalar>().template cast<double>();
    s.p = s.p.cast<Scalar>().template cast<double>();
    const double exact = static_cast<double>(test::long_double_distance(s.p, s.corners));
    const Scalar squared = form(s.p.cast<Scalar>(), s.corners[0].cast<Scalar>(),
                                s.corners[1].cast<Scalar>(), s.corners[2].cast<Scalar>());
    greatest = std::max(greatest, std::abs(static_cast<double>(squared) - exact * exact));
  }
  return greatest;
}

TEST(MatrixFree, IsRightToRoundingOnWellShapedTriangles) {
  EXPECT_LT(greatest_error<double>(ericson_squared_distance<double>, 81), 1e-12);
  EXPECT_LT(greatest_error<double>(eberly_squared_distance<double>, 82), 1e-12);
  EXPECT_LT(greatest_error<float>(ericson_squared_distance<float>, 83), 3e-4);
  EXPECT_LT(greatest_error<float>(eberly_squared_distance<float>, 84), 3e-4);
}

TEST(MatrixFree, AgreesWithTheKernel) {
  test::Random random(85);
  for (int i = 0; i < 50000; ++i) {
    const Sample s = well_shaped(random);
    const Vector3<float> p = {static_cast<float>(s.p.x()), static_cast<float>(s.p.y()),
                              static_cast<float>(s.p.z())};
    const Point rounded(p.x, p.y, p.z);
    const double kernel = std::sqrt(static_cast<double>(
        bits_float(pair_squared_bits(p, make_record(make_frame(s.corners), 0)))));
    for (const Form<double> form :
         {ericson_squared_distance<double>, eberly_squared_distance<double>}) {
      const double squared = form(rounded, s.corners[0], s.corners[1], s.corners[2]);
      ASSERT_NEAR(std::sqrt(squared), kernel, 5e-6) << "seed 85, " << i;
    }
  }
}

// One point in each region, by hand; a wrong region shows as a wrong number.
TEST(MatrixFree, KnowsTheSevenRegions) {
  const Point a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  for (const Form<double> form :
       {ericson_squared_distance<double>, eberly_squared_distance<double>}) {
    EXPECT_DOUBLE_EQ(form(Point(1, 1, 2), a, b, c), 4);
    EXPECT_DOUBLE_EQ(form(Point(-3, -4, 0), a, b, c), 25);
    EXPECT_DOUBLE_EQ(form(Point(7, -4, 0), a, b, c), 25);
    EXPECT_DOUBLE_EQ(form(Point(-3, 7, 0), a, b, c), 25);
    EXPECT_DOUBLE_EQ(form(Point(2, -3, 4), a, b, c), 25);
    EXPECT_DOUBLE_EQ(form(Point(-4, 2, 3), a, b, c), 25);
    EXPECT_DOUBLE_EQ(form(Point(5, 5.5, 0), a, b, c), 25);
  }
}

// Why the project does not decide by them: the frame keeps slivers, these lose them in binary32.
TEST(MatrixFree, LosesSliversInBinary32WhereTheFrameDoesNot) {
  test::Random random(86);
  double ericson = 0, kernel = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point a = random.point(-1, 1), b = random.point(-1, 1);
    Corners corners = {a, b, a + random.uniform(0, 1) * (b - a) + 1e-5 * random.point(-1, 1)};
    for (Point& c : corners) c = c.cast<float>().cast<double>();
    const Point p = random.point(-1, 1).cast<float>().cast<double>();
    const double exact = static_cast<double>(test::long_double_distance(p, corners));
    const float squared =
        ericson_squared_distance<float>(p.cast<float>(), corners[0].cast<float>(),
                                        corners[1].cast<float>(), corners[2].cast<float>());
    const Vector3<float> point = {static_cast<float>(p.x()), static_cast<float>(p.y()),
                                  static_cast<float>(p.z())};
    const std::uint32_t bits = pair_squared_bits(point, make_record(make_frame(corners), 0));
    ericson = std::max(ericson, std::abs(std::sqrt(static_cast<double>(squared)) - exact));
    kernel = std::max(kernel, std::abs(std::sqrt(static_cast<double>(bits_float(bits))) - exact));
  }
  EXPECT_GT(ericson, 1e-4) << "seed 86";
  EXPECT_LT(kernel, 2e-6) << "seed 86";
}

}  // namespace
}  // namespace emax
