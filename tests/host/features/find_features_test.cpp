#include "host/features/find_features.h"

#include <gtest/gtest.h>

#include <numbers>

#include "sw_model/base/deliberate_fault.h"
#include "tests/host/features/clouds.h"

namespace emax::test {
namespace {

constexpr double kNoise = 0.003;

std::size_t planes_in(const Features& features) {
  return static_cast<std::size_t>(std::ranges::count_if(
      features.regions, [](const Region& r) { return std::holds_alternative<Plane>(r.shape); }));
}

// The plane that is nearest to this one `there`, and by how much they differ.
struct Match {
  double angle = 10, offset = 10;
  std::size_t points = 0;
};
Match match(const Features& features, const Plane& truth, const Point& there = Point::Zero()) {
  Match best;
  for (const Region& region : features.regions) {
    const auto* plane = std::get_if<Plane>(&region.shape);
    if (!plane) continue;
    const double angle = std::acos(std::min(1.0, std::abs(plane->normal.dot(truth.normal))));
    const double offset = std::abs(plane->signed_distance(there) - truth.signed_distance(there));
    if (angle < 0.05 && offset < best.offset) best = {angle, offset, region.points.size()};
  }
  return best;
}

std::vector<Point> scanned_box(Random& random, double outliers) {
  std::vector<Point> cloud;
  for (const Patch& side : sides_of_box({0, 0, 0}, {3, 2, 1})) {
    scan_patch(side, 4000, kNoise, random, cloud);
  }
  const auto count = static_cast<std::size_t>(outliers * static_cast<double>(cloud.size()));
  for (std::size_t i = 0; i < count; ++i) {
    cloud.push_back((random.point(-0.3, 1.3)).cwiseProduct(Point(3, 2, 1)));
  }
  return cloud;
}

class FindPlanes : public testing::TestWithParam<PlaneMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, FindPlanes,
                         testing::Values(PlaneMethod::kGrowing, PlaneMethod::kHough),
                         [](const auto& method) {
                           return method.param == PlaneMethod::kHough ? "Hough" : "Growing";
                         });

TEST_P(FindPlanes, FindsTheSidesOfABox) {
  for (const double outliers : {0.0, 0.05}) {
    Random random(named_seed("box", 1));
    const std::vector<Point> cloud = scanned_box(random, outliers);
    const Features features = find_features(cloud, {.planes = GetParam(), .max_error = 0.015});
    EXPECT_EQ(features.regions.size(), 6u);
    for (const Patch& side : sides_of_box({0, 0, 0}, {3, 2, 1})) {
      const Match found = match(features, side.plane());
      EXPECT_LT(found.angle, 0.1 * std::numbers::pi / 180);
      EXPECT_LT(found.offset, 0.001);
      EXPECT_GT(found.points, 3700u);
    }
    for (const Region& region : features.regions) {
      EXPECT_NEAR(region.rms, kNoise, 0.2 * kNoise);
      EXPECT_GE(region.outline.size(), 4u);
      for (const Point& corner : region.outline) {
        EXPECT_LT(distance(region.shape, corner), 1e-9);
      }
      EXPECT_FALSE(region.may_be_curved);
    }
  }
}

TEST_P(FindPlanes, IsTheSameForAnyNumberOfThreads) {
  Random random(named_seed("box", 2));
  const std::vector<Point> cloud = scanned_box(random, 0.05);
  const Features one = find_features(cloud, {.planes = GetParam(), .threads = 1});
  const Features three = find_features(cloud, {.planes = GetParam(), .threads = 3});
  ASSERT_EQ(one.regions.size(), three.regions.size());
  for (std::size_t r = 0; r < one.regions.size(); ++r) {
    EXPECT_EQ(one.regions[r].points, three.regions[r].points);
    EXPECT_EQ(one.regions[r].rms, three.regions[r].rms);
    EXPECT_EQ(one.regions[r].outline, three.regions[r].outline);
  }
}

// In coordinates of a survey, seven digits before the point.
TEST_P(FindPlanes, WorksFarFromTheOrigin) {
  Random random(named_seed("box", 3));
  std::vector<Point> cloud = scanned_box(random, 0);
  const Point far(445'000, 5'300'000, 240);
  for (Point& p : cloud) p += far;
  const Features features = find_features(cloud, {.planes = GetParam(), .max_error = 0.015});
  for (Patch side : sides_of_box({0, 0, 0}, {3, 2, 1})) {
    side.corner += far;
    EXPECT_LT(match(features, side.plane(), far).angle, 0.1 * std::numbers::pi / 180);
  }
  EXPECT_EQ(features.regions.size(), 6u);
}

// Every point is there twice.
TEST_P(FindPlanes, CountsPointsThatCoincide) {
  Random random(named_seed("box", 4));
  std::vector<Point> cloud = scanned_box(random, 0);
  const Features once = find_features(cloud, {.planes = GetParam(), .max_error = 0.015});
  cloud.insert(cloud.end(), cloud.begin(), cloud.end());
  const Features twice = find_features(cloud, {.planes = GetParam(), .max_error = 0.015});
  ASSERT_EQ(twice.regions.size(), once.regions.size());
  for (std::size_t r = 0; r < once.regions.size(); ++r) {
    EXPECT_EQ(twice.regions[r].points.size(), 2 * once.regions[r].points.size());
  }
}

// A column and a ball on a floor.
std::vector<Point> furnished_floor() {
  Random random(named_seed("furnished floor", 1));
  std::vector<Point> cloud;
  scan_patch({{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}, 20'000, kNoise, random, cloud);
  scan_cylinder({{1, 1, 1.5}, {0, 0, 1}, 0.35}, 2.8, 2 * std::numbers::pi, 8000, kNoise, random,
                cloud);
  scan_sphere({{3, 2, 1}, 0.5}, 5000, kNoise, random, cloud);
  return cloud;
}

TEST_P(FindPlanes, FindsCylindersAndSpheres) {
  const Features features =
      find_features(furnished_floor(), {.planes = GetParam(), .max_error = 0.015});
  ASSERT_EQ(features.regions.size(), 3u);
  EXPECT_LT(match(features, {{0, 0, 1}, 0}).offset, 0.001);
  const auto* cylinder = std::get_if<Cylinder>(&features.regions[1].shape);
  const auto* sphere = std::get_if<Sphere>(&features.regions[2].shape);
  ASSERT_TRUE(cylinder && sphere);
  EXPECT_NEAR(cylinder->radius, 0.35, 0.001);
  EXPECT_LT((Point(1, 1, cylinder->centre.z()) - cylinder->centre).norm(), 0.002);
  EXPECT_NEAR(features.regions[1].area, 2 * std::numbers::pi * 0.35 * 2.8, 0.4);
  EXPECT_NEAR(sphere->radius, 0.5, 0.001);
  EXPECT_LT((Point(3, 2, 1) - sphere->centre).norm(), 0.001);
  EXPECT_NEAR(features.regions[2].area, std::numbers::pi, 0.1);
}

// Within the band a strip of the column is flat.
TEST(FindFeaturesFault, StripsOfAColumnAsPlanesAreCaught) {
  const FeatureSearch search = {.curved = false, .max_error = 0.015};
  EXPECT_EQ(planes_in(find_features(furnished_floor(), search)), 1u);
  const DeliberateFault fault(Fault::kCurvedIsPlane);
  EXPECT_GT(planes_in(find_features(furnished_floor(), search)), 2u);
}

TEST(FindFeatures, NoiseHasNoFeatures) {
  Random random(named_seed("nothing", 1));
  std::vector<Point> cloud;
  for (std::size_t i = 0; i < 20'000; ++i) cloud.push_back(random.point(-1, 1));
  for (const double max_error : {0.02, 0.05, 0.1}) {
    EXPECT_TRUE(find_features(cloud, {.max_error = max_error}).regions.empty()) << max_error;
  }
}

// Two sheets that cross at 35 degrees: near the line where they meet, points of one lie within the
// band of the other.
TEST(FindFeaturesFault, PointsOfASheetThatCrossesAreCaught) {
  Random random(named_seed("crossing", 1));
  std::vector<Point> cloud;
  constexpr std::size_t kEach = 30'000;
  const double angle = 35 * std::numbers::pi / 180;
  scan_patch({{-0.25, -0.25, 0}, {0.5, 0, 0}, {0, 0.5, 0}}, kEach, 0.0005, random, cloud);
  const Point across(std::cos(angle), 0, std::sin(angle));
  scan_patch({-0.25 * across - Point(0, 0.25, 0), 0.5 * across, {0, 0.5, 0}}, kEach, 0.0005, random,
             cloud);
  const auto strangers = [&] {
    const Features features = find_features(cloud, {.curved = false, .max_error = 0.015});
    EXPECT_GE(features.regions.size(), 2u);
    std::size_t count = 0;
    for (const Region& region : features.regions) {
      const bool is_first = std::get<Plane>(region.shape).normal.z() > 0.99;
      count += static_cast<std::size_t>(std::ranges::count_if(
          region.points, [&](std::uint32_t i) { return (i < kEach) != is_first; }));
    }
    return count;
  };
  const std::size_t few = strangers();
  const DeliberateFault fault(Fault::kFitsEveryNormal);
  EXPECT_GT(strangers(), 2 * few);
}

}  // namespace
}  // namespace emax::test
