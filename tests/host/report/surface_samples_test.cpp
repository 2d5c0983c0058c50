#include "host/report/surface_samples.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/support/long_double_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(SurfaceSamples, LieOnTheMeshInProportionToArea) {
  // Areas 1/2 and 3/2, and a triangle without any between them.
  const std::vector<Point> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                       {0, 0, 5}, {3, 0, 5}, {0, 1, 5}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {3, 3, 4}, {3, 4, 5}};
  const auto samples = surface_samples({vertices, triangles}, 1000);
  ASSERT_EQ(samples.size(), 1000u);
  std::size_t low = 0, first_third = 0;
  for (const Point& p : samples) {
    EXPECT_TRUE(p.z() == 0 || p.z() == 5);
    const double scale = p.z() == 0 ? 1 : 3;
    EXPECT_GE(p.minCoeff(), 0);
    EXPECT_LE(p.x() / scale + p.y(), 1 + 1e-12);
    low += p.z() == 0 ? 1 : 0;
    first_third += p.z() == 5 && p.x() < 1 ? 1 : 0;
  }
  EXPECT_EQ(low, 250u);
  // 5/9 of the large triangle lies at x < 1.
  EXPECT_NEAR(static_cast<double>(first_third), 750 * 5.0 / 9, 10);
}

TEST(SurfaceSamples, MeanOfACoordinateIsTheIntegral) {
  const test::Stimulus s = test::bumpy_sphere(20, 30, 0, 302);
  double area = 0, integral = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const auto v = s.mesh().corners(t);
    const double a = (v[1] - v[0]).cross(v[2] - v[0]).norm() / 2;
    area += a;
    integral += a * std::abs(v[0].x() + v[1].x() + v[2].x()) / 3;
  }
  double sum = 0;
  for (const Point& p : surface_samples(s.mesh(), 20000)) sum += std::abs(p.x());
  EXPECT_NEAR(sum / 20000, integral / area, 0.003);
}

TEST(SurfaceSamples, OfAMeshWithoutAreaAreItsVertices) {
  const std::vector<Point> vertices = {{0, 0, 0}, {1, 0, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 1}};
  EXPECT_EQ(surface_samples({vertices, triangles}, 50), vertices);
}

}  // namespace
}  // namespace emax
