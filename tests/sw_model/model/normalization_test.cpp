#include "sw_model/model/normalization.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(Normalization, BringsTheLargestHalfExtentIntoHalfOpenUnit) {
  test::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const double size = std::pow(10.0, random.uniform(-9, 9));
    std::vector<Point> cloud;
    for (int k = 0; k < 20; ++k) cloud.push_back(random.point(3 * size, 5 * size));
    const Normalization normalization = normalization_of(cloud);
    double largest = 0;
    for (const Point& p : cloud) {
      largest = std::max(largest, normalization.apply(p).cwiseAbs().maxCoeff());
    }
    EXPECT_GT(largest, 0.5);
    EXPECT_LE(largest, 1);
    int exponent = 0;
    EXPECT_EQ(std::frexp(normalization.scale, &exponent), 0.5) << "a power of two";
  }
}

TEST(Normalization, TakesTheExactHalfToTheUpperEnd) {
  const std::vector<Point> cloud = {Point(-4, 0, 0), Point(4, 1, 1)};
  EXPECT_EQ(normalization_of(cloud).scale, 0.25);
}

TEST(Normalization, KeepsMillimetresFarFromTheOrigin) {
  std::vector<Point> cloud;
  for (int i = 0; i < 1000; ++i) cloud.emplace_back(1e7 + i * 1e-3, 2e7, -1e7 + i);
  const auto points = normalized_points(cloud, normalization_of(cloud));
  for (int i = 1; i < 1000; ++i) ASSERT_GT(points[i].x, points[i - 1].x);
}

TEST(Normalization, OfEqualPointsIsTheirPlace) {
  const std::vector<Point> cloud(5, Point(1, 2, 3));
  EXPECT_EQ(normalization_of(cloud).origin, Point(1, 2, 3));
  EXPECT_EQ(normalization_of(cloud).scale, 1);
}

TEST(Normalization, RefusesNothingAndNan) {
  EXPECT_THROW(normalization_of({}), std::invalid_argument);
  const std::vector<Point> cloud = {Point(0, 0, std::nan(""))};
  EXPECT_THROW(normalization_of(cloud), std::invalid_argument);
}

}  // namespace
}  // namespace emax
