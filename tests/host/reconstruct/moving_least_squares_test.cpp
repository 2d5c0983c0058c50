#include "host/reconstruct/moving_least_squares.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sw_model/base/error.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

constexpr std::uint64_t kSmoothingSeed = 41;

ParameterValues values(Mls::Method method) {
  ParameterValues values;
  values.set(Mls::kMethod, method);
  values.set(Mls::kRadius, 6);
  values.set(Mls::kOrder, 2);
  values.set(Mls::kCell, 2);
  return values;
}

std::vector<Point> noisy_sphere(double noise) {
  Random random(kSmoothingSeed);
  std::vector<Point> points = sphere_cloud(3000);
  for (Point& p : points) p *= 1 + random.uniform(-noise, noise);
  return points;
}

double root_mean_square_error(const std::vector<Point>& points) {
  double sum = 0;
  for (const Point& p : points) sum += (p.norm() - 1) * (p.norm() - 1);
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(MovingLeastSquares, NoneLeavesEveryBit) {
  const std::vector<Point> cloud = noisy_sphere(0.01);
  EXPECT_EQ(on_least_squares_surface(cloud, values(Mls::Method::kNone)), cloud);
}

TEST(MovingLeastSquares, SmoothingTakesMostOfTheNoise) {
  const std::vector<Point> cloud = noisy_sphere(0.01);
  const std::vector<Point> smooth = on_least_squares_surface(cloud, values(Mls::Method::kSmooth));
  ASSERT_EQ(smooth.size(), cloud.size());
  EXPECT_LT(root_mean_square_error(smooth), 0.3 * root_mean_square_error(cloud));
  for (std::size_t i = 0; i < cloud.size(); ++i)
    EXPECT_LT((smooth[i] - cloud[i]).norm(), 0.05) << i;
  EXPECT_EQ(on_least_squares_surface(cloud, values(Mls::Method::kSmooth)), smooth);
}

TEST(MovingLeastSquares, ResamplingEvensTheDensity) {
  std::vector<Point> cloud = noisy_sphere(0.005);
  Random random(kSmoothingSeed + 1);
  for (int i = 0; i < 4000; ++i) {  // the north is scanned once more
    const double turn = random.uniform(0, 6.28), z = random.uniform(0.5, 1);
    const double r = std::sqrt(1 - z * z);
    cloud.push_back({r * std::cos(turn), r * std::sin(turn), z});
  }
  ParameterValues coarse = values(Mls::Method::kResample);
  coarse.set(Mls::kCell, 4);
  const std::vector<Point> even = on_least_squares_surface(cloud, coarse);
  EXPECT_LT(even.size(), cloud.size() / 2);
  const auto share_of_north = [](const std::vector<Point>& points) {
    const auto north = std::ranges::count_if(points, [](const Point& p) { return p.z() > 0.5; });
    return static_cast<double>(north) / static_cast<double>(points.size());
  };
  EXPECT_GT(share_of_north(cloud), 0.6);
  EXPECT_NEAR(share_of_north(even), 0.25, 0.08);
  EXPECT_LT(root_mean_square_error(even), 0.003);
}

TEST(MovingLeastSquares, APointOnItsOwnStays) {
  std::vector<Point> cloud = noisy_sphere(0.01);
  const Point alone(5, 5, 5);
  cloud.insert(cloud.begin() + 100, alone);
  const std::vector<Point> smooth = on_least_squares_surface(cloud, values(Mls::Method::kSmooth));
  ASSERT_EQ(smooth.size(), cloud.size());
  EXPECT_EQ(smooth[100], alone);
}

// A paraboloid is its own quadratic fit, far from the origin too.
TEST(LeastSquaresPatch, ReproducesAQuadraticSurface) {
  Random random(kSmoothingSeed + 2);
  for (const Point& origin : {Point(0, 0, 0), Point(1e6, -1e6, 3e5)}) {
    std::vector<Point> points;
    for (int i = 0; i < 60; ++i) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      if (std::hypot(x, y) < 0.5) continue;
      points.push_back(origin + Point(x, y, 0.2 * (x * x + y * y)));
    }
    const LeastSquaresPatch patch(points, 1);
    for (int i = 0; i < 20; ++i) {
      const double x = random.uniform(-0.4, 0.4), y = random.uniform(-0.4, 0.4);
      const Point p = patch.project(origin + Point(x, y, 0)) - origin;
      EXPECT_NEAR(p.z(), 0.2 * (p.x() * p.x() + p.y() * p.y()), 0.01);
    }
  }
}

// Too few for a quadratic: a square's four corners, a little out of plane, and one more.
TEST(LeastSquaresPatch, FitsAPlaneToFewPoints) {
  std::vector<Point> points = {{1, 1, 0.01}, {-1, 1, -0.01}, {-1, -1, 0.01}};
  for (const Point& next : {Point(1, -1, -0.01), Point(0, 0, 0), Point(0.5, 0, 0)}) {
    const Point p = LeastSquaresPatch(points, 1).project({0.1, 0.2, 0.3});
    EXPECT_NEAR(p.z(), 0, 0.05) << points.size();
    points.push_back(next);
  }
}

}  // namespace
}  // namespace emax::test
