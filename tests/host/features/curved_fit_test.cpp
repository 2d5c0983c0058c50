#include "host/features/curved_fit.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/host/features/clouds.h"

namespace emax::test {
namespace {

std::vector<std::uint32_t> every(const std::vector<Point>& cloud) {
  std::vector<std::uint32_t> members(cloud.size());
  std::iota(members.begin(), members.end(), 0u);
  return members;
}

template <class S>
double squares(const std::vector<Point>& cloud, const S& shape) {
  double sum = 0;
  for (const Point& p : cloud) sum += std::pow(shape.signed_distance(p), 2);
  return sum;
}

TEST(CurvedFit, TwoOrientedPointsGiveTheirCylinder) {
  Random random(named_seed("curved fit", 1));
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    const Cylinder truth = {random.point(-3, 3), canonical_sign(random.point(-1, 1).normalized()),
                            0.7};
    std::vector<Point> two;
    scan_cylinder(truth, 2, 6, 2, 0, random, two);
    const auto cylinder =
        cylinder_through(two[0], truth.normal_at(two[0]), two[1], -truth.normal_at(two[1]), 1e-6);
    if (!cylinder) continue;  // the normals are nearly parallel
    ++found;
    EXPECT_NEAR(cylinder->radius, 0.7, 1e-9);
    EXPECT_NEAR(std::abs(cylinder->axis.dot(truth.axis)), 1, 1e-9);
    EXPECT_LT(truth.outward(cylinder->centre).norm(), 1e-9);
  }
  EXPECT_GT(found, 80);
}

TEST(CurvedFit, TwoOrientedPointsGiveTheirSphere) {
  Random random(named_seed("curved fit", 2));
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    const Sphere truth = {random.point(-3, 3), 0.7};
    std::vector<Point> two;
    scan_sphere(truth, 2, 0, random, two);
    const auto sphere =
        sphere_through(two[0], -truth.normal_at(two[0]), two[1], truth.normal_at(two[1]), 1e-6);
    if (!sphere) continue;
    ++found;
    EXPECT_NEAR(sphere->radius, 0.7, 1e-9);
    EXPECT_LT((sphere->centre - truth.centre).norm(), 1e-9);
  }
  EXPECT_GT(found, 80);
}

// Neither of the truth nor of any shape near the result are the squares less: the twin is a search
// step by step along every parameter.
TEST(CurvedFit, LeastSquaresAreLeast) {
  Random random(named_seed("curved fit", 3));
  const Cylinder truth = {{1, 2, 3}, Point(0.2, 0.1, 1).normalized(), 0.5};
  std::vector<Point> cloud;
  scan_cylinder(truth, 3, 2.5, 800, 0.004, random, cloud);
  Cylinder first = truth;
  first.centre += Point(0.02, -0.03, 0);
  first.axis = (first.axis + Point(0.02, 0.01, 0)).normalized();
  first.radius *= 1.1;
  const auto fitted = fit_cylinder(cloud, every(cloud), first);
  ASSERT_TRUE(fitted);
  const double least = squares(cloud, *fitted);
  EXPECT_LT(least, squares(cloud, truth));
  EXPECT_NEAR(fitted->radius, truth.radius, 0.001);
  EXPECT_NEAR(std::abs(fitted->axis.dot(truth.axis)), 1, 1e-6);
  const Point u = fitted->axis.unitOrthogonal(), v = fitted->axis.cross(u);
  for (const double step : {1e-4, -1e-4}) {
    for (const Point& d : {u, v}) {
      Cylinder moved = *fitted, turned = *fitted;
      moved.centre += step * d;
      turned.axis = (turned.axis + step * d).normalized();
      EXPECT_GT(squares(cloud, moved), least);
      EXPECT_GT(squares(cloud, turned), least);
    }
    Cylinder wider = *fitted;
    wider.radius += step;
    EXPECT_GT(squares(cloud, wider), least);
  }
}

TEST(CurvedFit, LeastSquaresOfASphereAreLeast) {
  Random random(named_seed("curved fit", 4));
  const Sphere truth = {{1, 2, 3}, 0.5};
  std::vector<Point> cloud;
  scan_sphere(truth, 800, 0.004, random, cloud);
  const auto fitted = fit_sphere(cloud, every(cloud), {{1.05, 1.98, 3}, 0.45});
  ASSERT_TRUE(fitted);
  const double least = squares(cloud, *fitted);
  EXPECT_LT(least, squares(cloud, truth));
  EXPECT_LT((fitted->centre - truth.centre).norm(), 0.001);
  for (const double step : {1e-4, -1e-4}) {
    for (int k = 0; k < 3; ++k) {
      Sphere moved = *fitted;
      moved.centre[k] += step;
      EXPECT_GT(squares(cloud, moved), least);
    }
  }
}

}  // namespace
}  // namespace emax::test
