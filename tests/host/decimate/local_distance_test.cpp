#include "host/decimate/local_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/decimate/slot_tree.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

std::vector<std::array<Point, 3>> shapes(Random& random) {
  std::vector<std::array<Point, 3>> all;
  for (int i = 0; i < 60; ++i) {
    const Point a = random.point(-1, 1), b = random.point(-1, 1);
    // Every third is a sliver.
    const Point c =
        i % 3 == 0 ? Point(a + 0.4 * (b - a) + 1e-3 * random.point(-1, 1)) : random.point(-1, 1);
    all.push_back({a, b, c});
  }
  return all;
}

TEST(LocalDistance, AgreesWithTheOracle) {
  Random random(3);
  for (const auto& corners : shapes(random)) {
    const std::array<LocalFrame, 1> frames = {local_frame(corners)};
    LocalPoints points;
    for (int i = 0; i < 37; ++i) points.push_back(random.point(-2, 2));
    measure(points, frames);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const DistanceBounds exact = point_triangle_distance(points.at(i), corners);
      EXPECT_NEAR(std::sqrt(points.squared[i]), exact.upper, 1e-12);
      EXPECT_NEAR(std::sqrt(squared_distance(points.at(i), corners)), exact.upper, 1e-12);
      EXPECT_NEAR(foot_on(frames[0], points.at(i)).residual.norm(), exact.upper, 1e-12);
    }
  }
}

TEST(LocalDistance, FindsTheNearestOfMany) {
  Random random(4);
  const auto all = shapes(random);
  std::vector<LocalFrame> frames;
  for (const auto& corners : all) frames.push_back(local_frame(corners));
  LocalPoints points;
  for (int i = 0; i < 101; ++i) points.push_back(random.point(-2, 2));
  measure(points, frames);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double least = 1e300;
    for (const auto& corners : all) {
      least = std::min(least, squared_distance(points.at(i), corners));
    }
    EXPECT_NEAR(points.squared[i], least, 1e-12);
    const auto nearest = static_cast<std::size_t>(points.nearest[i]);
    EXPECT_NEAR(squared_distance(points.at(i), all[nearest]), least, 1e-12);
  }
}

// Against the difference quotient: how the distance changes with the first corner.
TEST(LocalDistance, TheFootTellsHowTheDistanceMovesWithTheFirstCorner) {
  Random random(5);
  int compared = 0;
  for (const auto& corners : shapes(random)) {
    if ((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() < 0.1) continue;
    for (int i = 0; i < 20; ++i) {
      const Point p = random.point(-2, 2);
      const Foot foot = foot_on(local_frame(corners), p);
      if (foot.residual.norm() < 0.05) continue;
      const Point by = 1e-6 * random.point(-1, 1);
      auto ahead = corners, behind = corners;
      ahead[0] += by;
      behind[0] -= by;
      const double change =
          0.5 * (std::sqrt(squared_distance(p, ahead)) - std::sqrt(squared_distance(p, behind)));
      const double sign = foot.residual.dot(foot.direction) < 0 ? -1 : 1;
      EXPECT_NEAR(change, -sign * foot.weight * foot.direction.dot(by), 1e-9);
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}

}  // namespace
}  // namespace emax::test
