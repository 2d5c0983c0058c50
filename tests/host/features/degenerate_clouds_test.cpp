// Clouds without planes, or with too many: the search ends, and well.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>

#include "host/features/find_features.h"
#include "tests/host/features/clouds.h"

namespace emax::test {
namespace {

class DegenerateClouds : public testing::TestWithParam<PlaneMethod> {
 protected:
  static Features found(const std::vector<Point>& cloud, std::optional<double> max_error = {}) {
    return find_features(cloud, {.planes = GetParam(), .max_error = max_error});
  }
  Random random_ = Random(named_seed("degenerate clouds", 1));
};
INSTANTIATE_TEST_SUITE_P(Methods, DegenerateClouds,
                         testing::Values(PlaneMethod::kGrowing, PlaneMethod::kHough),
                         [](const auto& method) {
                           return method.param == PlaneMethod::kHough ? "Hough" : "Growing";
                         });

TEST_P(DegenerateClouds, WithoutPointsHaveNothing) {
  EXPECT_TRUE(found({}).regions.empty());
  EXPECT_TRUE(found({{1, 2, 3}, {4, 5, 6}}).regions.empty());
  EXPECT_TRUE(found(std::vector<Point>(1000, Point(1, 2, 3))).regions.empty());
  EXPECT_TRUE(found(std::vector<Point>(1000, Point(1, 2, 3)), 0.1).regions.empty());
}

TEST_P(DegenerateClouds, OnALineHaveNothing) {
  std::vector<Point> cloud;
  for (std::size_t i = 0; i < 2000; ++i) {
    cloud.push_back(random_.uniform(0, 1) * Point(1, 2, 3) + random_.point(-1e-4, 1e-4));
  }
  EXPECT_TRUE(found(cloud, 0.001).regions.empty());
  std::vector<Point> exact;
  for (int i = 0; i < 2000; ++i) exact.emplace_back(i, 0, 0);
  EXPECT_TRUE(found(exact, 0.1).regions.empty());
}

TEST_P(DegenerateClouds, OnOnePlaneAreOneRegion) {
  std::vector<Point> cloud;
  scan_patch({{0, 0, 0}, {1, 0.5, 0}, {0, 1, 0.7}}, 5000, 0, random_, cloud);
  const Features features = found(cloud);
  ASSERT_EQ(features.regions.size(), 1u);
  EXPECT_EQ(features.regions[0].points.size(), cloud.size());
  EXPECT_LT(features.regions[0].rms, 1e-12);
}

// Without a single plane: a smooth surface that is curved everywhere.
TEST_P(DegenerateClouds, WithoutAPlaneHaveNone) {
  std::vector<Point> cloud;
  for (std::size_t i = 0; i < 20'000; ++i) {
    const double x = random_.uniform(-1, 1), y = random_.uniform(-1, 1);
    cloud.emplace_back(x, y, x * x + y * y);
  }
  for (const Region& region : found(cloud, 0.01).regions) {
    EXPECT_FALSE(std::holds_alternative<Plane>(region.shape)) << region.points.size();
  }
}

TEST_P(DegenerateClouds, OnASphereAreThatSphere) {
  std::vector<Point> cloud;
  scan_sphere({{5, 6, 7}, 2}, 20'000, 0.002, random_, cloud);
  const Features features = found(cloud, 0.01);
  ASSERT_EQ(features.regions.size(), 1u);
  const auto* sphere = std::get_if<Sphere>(&features.regions[0].shape);
  ASSERT_TRUE(sphere);
  EXPECT_NEAR(sphere->radius, 2, 0.001);
  EXPECT_GT(features.regions[0].points.size(), 19'500u);
}

// Two sides of a thin wall, closer than the band: each point of both is in a region within the
// band.
TEST_P(DegenerateClouds, OfWallsCloserThanTheToleranceKeepToIt) {
  std::vector<Point> cloud;
  for (const double x : {0.0, 0.008}) {
    scan_patch({{x, 0, 0}, {0, 2, 0}, {0, 0, 2}}, 20'000, 0.0005, random_, cloud);
  }
  const Features features = found(cloud, 0.01);
  std::size_t points = 0;
  for (const Region& region : features.regions) {
    points += region.points.size();
    const auto* plane = std::get_if<Plane>(&region.shape);
    ASSERT_TRUE(plane);
    EXPECT_GT(plane->normal.x(), 0.999);
    EXPECT_LT(region.rms, 0.01);
    for (const std::uint32_t i : region.points) {
      EXPECT_LE(distance(region.shape, cloud[i]), 0.01 * (1 + 1e-9));
    }
  }
  EXPECT_LE(features.regions.size(), 2u);
  EXPECT_GT(points, 39'000u);
}

TEST_P(DegenerateClouds, OfNoiseHaveNothing) {
  std::vector<Point> cloud;
  for (std::size_t i = 0; i < 20'000; ++i) cloud.push_back(random_.point(-1, 1));
  EXPECT_TRUE(found(cloud).regions.empty());
  EXPECT_TRUE(found(cloud, 0.05).regions.empty());
  for (std::size_t i = 0; i < 20'000; ++i) {  // and a wall in it
    cloud.emplace_back(0.2, random_.uniform(-1, 1), random_.uniform(-1, 1));
  }
  const Features features = found(cloud, 0.01);
  ASSERT_EQ(features.regions.size(), 1u);
  EXPECT_NEAR(std::get<Plane>(features.regions[0].shape).offset, 0.2, 0.001);
}

// A sheet of side^2 squares that is crumpled up to `height`: in each square one facet, with so many
// points.
std::vector<Point> crumpled(std::size_t side, double height, int points, Random& random) {
  std::vector<double> heights((side + 1) * (side + 1));
  for (double& h : heights) h = random.uniform(-height, height);
  std::vector<Point> cloud;
  for (std::size_t x = 0; x < side; ++x) {
    for (std::size_t y = 0; y < side; ++y) {
      const double here = heights[x * (side + 1) + y];
      const double right = heights[(x + 1) * (side + 1) + y], up = heights[x * (side + 1) + y + 1];
      for (int i = 0; i < points; ++i) {
        const double s = random.uniform(0, 1), t = random.uniform(0, 1) * (1 - s);
        cloud.emplace_back(static_cast<double>(x) + s, static_cast<double>(y) + t,
                           here + s * (right - here) + t * (up - here));
      }
    }
  }
  return cloud;
}

TEST_P(DegenerateClouds, OfTinyFacetsHaveNothing) {
  EXPECT_TRUE(found(crumpled(70, 1, 10, random_), 0.01).regions.empty());
}

// Of the processor, by all threads.
double seconds_of(const std::function<void()>& work) {
  const std::clock_t begun = std::clock();
  work();
  return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
}

// The time grows hardly faster than the number of facets.
TEST_P(DegenerateClouds, OfAMillionTinyFacetsEndSoon) {
  const std::vector<Point> few = crumpled(200, 1, 3, random_);
  const std::vector<Point> many = crumpled(1000, 1, 3, random_);
  const double short_time = seconds_of([&] { EXPECT_TRUE(found(few, 0.01).regions.empty()); });
  const double long_time = seconds_of([&] { EXPECT_TRUE(found(many, 0.01).regions.empty()); });
  EXPECT_LT(long_time, 3 * 25 * short_time);
}

// Facets that are lower than the band are one plane.
TEST_P(DegenerateClouds, OfTinyFacetsWithinTheBandAreOnePlane) {
  const std::vector<Point> cloud = crumpled(70, 0.2, 10, random_);
  const Features features = found(cloud, 0.3);
  ASSERT_EQ(features.regions.size(), 1u);
  EXPECT_GT(std::get<Plane>(features.regions[0].shape).normal.z(), 0.999);
  EXPECT_GT(features.regions[0].points.size(), cloud.size() * 9 / 10);
}

}  // namespace
}  // namespace emax::test
