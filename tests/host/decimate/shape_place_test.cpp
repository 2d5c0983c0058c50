#include "host/decimate/shape_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sw_model/base/deliberate_fault.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

const Plane kFloor = {{0, 0, 1}, 1}, kWall = {{1, 0, 0}, 2}, kSide = {{0, 1, 0}, 3};

TEST(ShapePlace, OfOnePlaneIsAllOfIt) {
  const std::vector<Shape> planes = {kFloor};
  const auto place = place_on(planes, {5, 6, 7}, 0.1);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->project({5, 6, 7}), Point(5, 6, 1));
  EXPECT_EQ(place->project({8, 9, 10}), Point(8, 9, 1));
}

TEST(ShapePlace, OfTwoPlanesIsTheirLineAndOfThreeTheirCorner) {
  const std::vector<Shape> planes = {kFloor, kWall, kSide};
  const auto line = place_on(std::span(planes).first(2), {5, 6, 7}, 0.1);
  ASSERT_TRUE(line);
  EXPECT_LT((line->project({8, 9, 10}) - Point(2, 9, 1)).norm(), 1e-12);
  const auto corner = place_on(planes, {5, 6, 7}, 0.1);
  ASSERT_TRUE(corner);
  EXPECT_LT((corner->project({8, 9, 10}) - Point(2, 3, 1)).norm(), 1e-12);
}

TEST(ShapePlace, IsNoneOfPlanesThatShareNoPoint) {
  const std::vector<Shape> parallel = {kFloor, Plane{{0, 0, 1}, 1.5}};
  EXPECT_FALSE(place_on(parallel, {0, 0, 0}, 0.1));
  const Point tilted = Point(1, 1, 1).normalized();
  std::vector<Shape> four = {kFloor, kWall, kSide, Plane{tilted, tilted.dot(Point(2, 3, 1))}};
  EXPECT_TRUE(place_on(four, {0, 0, 0}, 0.1));
  std::get<Plane>(four.back()).offset += 0.5;
  EXPECT_FALSE(place_on(four, {0, 0, 0}, 0.1));
}

// Otherwise the least tilt of a plane would throw the line far away.
TEST(ShapePlace, TakesPlanesThatHardlyDifferAsOne) {
  const Point tilted = Point(0.01, 0, 1).normalized();
  const std::vector<Shape> planes = {Plane{{0, 0, 1}, 1}, Plane{tilted, tilted.z() * 1.02}};
  const auto place = place_on(planes, {0.5, 6, 7}, 0.1);
  ASSERT_TRUE(place);
  const Point at = place->project({0.5, 6, 7});
  EXPECT_NEAR(at.z(), 1.01, 0.005);
  EXPECT_NEAR(at.x(), 0.5, 0.05);
}

constexpr double kApart = 0.05;

double farthest_shape(std::span<const Shape> shapes, const Point& p) {
  double farthest = 0;
  for (const Shape& shape : shapes) farthest = std::max(farthest, distance(shape, p));
  return farthest;
}

TEST(ShapePlace, OfACylinderOrASphereIsItsNearestPoint) {
  const std::vector<Shape> cylinder = {Cylinder{{1, 2, 3}, {0, 0, 1}, 2}};
  const auto side = place_on(cylinder, {1, 5, 4}, kApart);
  ASSERT_TRUE(side);
  EXPECT_LT((side->project({1, 5, 4}) - Point(1, 4, 4)).norm(), 1e-12);
  EXPECT_LT((side->project({-3, 2, 9}) - Point(-1, 2, 9)).norm(), 1e-12);
  EXPECT_LT((side->along({1, 4, 4}) * Point(1, 1, 1) - Point(1, 0, 1)).norm(), 1e-12);
  EXPECT_LT((side->along({-1, 2, 4}) * Point(1, 1, 1) - Point(0, 1, 1)).norm(), 1e-12);
  const std::vector<Shape> sphere = {Sphere{{1, 2, 3}, 2}};
  const auto ball = place_on(sphere, {1, 2, 6}, kApart);
  ASSERT_TRUE(ball);
  EXPECT_LT((ball->project({5, 2, 3}) - Point(3, 2, 3)).norm(), 1e-12);
  EXPECT_FALSE(place_on(sphere, {1, 2, 3}, kApart));    // its middle is near no point of it
  EXPECT_FALSE(place_on(cylinder, {1, 2, 3}, kApart));  // nor is the axis
}

// The line where a slanted plane meets a cylinder, against its points by the angle.
TEST(ShapePlace, BetweenAPlaneAndACylinderIsAsNearAsTheirLine) {
  Random random(named_seed("shape place", 1));
  const Cylinder cylinder{{0, 0, 0}, {0, 0, 1}, 1};
  const Plane slanted{Point(0.3, -0.2, 1).normalized(), 0.1};
  const std::vector<Shape> both = {slanted, cylinder};
  const auto line_at = [&](double angle) {
    const double x = std::cos(angle), y = std::sin(angle);
    return Point(
        x, y,
        (slanted.offset - slanted.normal.x() * x - slanted.normal.y() * y) / slanted.normal.z());
  };
  for (int i = 0; i < 100; ++i) {
    const Point near = line_at(random.uniform(0, 2 * std::numbers::pi)) + random.point(-0.1, 0.1);
    double least = 1;
    for (int k = 0; k < 4000; ++k) {
      least = std::min(least, (line_at(2 * std::numbers::pi * k / 4000) - near).norm());
    }
    const auto place = place_on(both, near, kApart);
    ASSERT_TRUE(place);
    const Point at = place->project(near);
    EXPECT_LT(farthest_shape(both, at), 1e-12);
    EXPECT_LT((at - near).norm(), 1.1 * least + 1e-6);
    EXPECT_LT((place->project(at) - at).norm(), 1e-12);
    // Along the line, at a right angle to both normals.
    const Point along = place->along(at) * Point(random.point(-1, 1));
    EXPECT_NEAR(along.dot(slanted.normal), 0, 1e-12);
    EXPECT_NEAR(along.dot(cylinder.normal_at(at)), 0, 1e-12);
  }
}

TEST(ShapePlace, OfThreeShapesIsTheirCorner) {
  const std::vector<Shape> three = {kFloor, Cylinder{{0, 0, 0}, {0, 1, 0}, 2},
                                    Sphere{{0, 0, 0}, 3}};
  const Point corner(std::sqrt(3.0), std::sqrt(5.0), 1);
  const auto place = place_on(three, corner + Point(0.1, -0.1, 0.1), kApart);
  ASSERT_TRUE(place);
  EXPECT_LT((place->project({2, 2, 1.2}) - corner).norm(), 1e-9);
}

// Where the steps lead nowhere from a point, the known one is taken.
TEST(ShapePlace, IsNoneOfCurvedShapesThatDoNotMeet) {
  const std::vector<Shape> apart = {Sphere{{0, 0, 0}, 1}, Sphere{{0, 0, 3}, 1}};
  EXPECT_FALSE(place_on(apart, {0.2, 0.1, 1.5}, kApart));
  const std::vector<Shape> both = {kFloor, Sphere{{0, 0, 0}, 2}};
  const auto place = place_on(both, {2, 0, 1}, kApart);
  ASSERT_TRUE(place);
  EXPECT_LT(farthest_shape(both, place->project({0, 0, 0})), 1e-9);
}

// A rounded edge: the cylinder touches the plane, so the line where they meet is not known.
TEST(ShapePlace, TakesACylinderThatTouchesAPlaneAsOneWithIt) {
  const std::vector<Shape> touching = {kFloor, Cylinder{{0, 0, 0}, {0, 1, 0}, 1}};
  const auto place = place_on(touching, {0.05, 3, 1.01}, kApart);
  ASSERT_TRUE(place);
  EXPECT_LT(farthest_shape(touching, place->project({0.05, 3, 1.01})), 0.002);
}

TEST(ShapePlaceFault, ThatTakesTangentsIsSeen) {
  const std::vector<Shape> both = {kFloor, Sphere{{0, 0, 0}, 2}};
  const DeliberateFault fault(Fault::kTakesTangents);
  const auto place = place_on(both, {1.8, 0.1, 1.1}, kApart);
  ASSERT_TRUE(place);
  EXPECT_GT(farthest_shape(both, place->project({1.8, 0.1, 1.1})), 1e-6);
}

}  // namespace
}  // namespace emax::test
