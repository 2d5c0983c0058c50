#include "host/decimate/joining_distance.h"

#include <gtest/gtest.h>

#include "sw_model/certify/exact_distance.h"

namespace emax::test {
namespace {

const TriangleMesh& unit_square() {
  static const TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                    {{0, 1, 2}, {0, 2, 3}}};
  return mesh;
}

// Points over the square, the first `far` of every thousand at 0.7, the others at 0.2.
std::vector<Point> points_above(std::size_t thousands, std::size_t far) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < 1000 * thousands; ++i) {
    const double x = static_cast<double>(i % 1000) / 1000;
    points.push_back({x, 0.5, i % 1000 < far ? 0.7 : 0.2});
  }
  return points;
}

std::pair<double, double> as_pair(const JoiningDistance& far) {
  return {far.with_others, far.alone};
}

TEST(JoiningDistance, IsHalfOfTheToleranceWhereFewPointsAreFartherThanThat) {
  EXPECT_EQ(as_pair(joining_distance(unit_square(), points_above(3, 19), 1)), std::pair(0.5, 0.9));
  EXPECT_EQ(as_pair(joining_distance(unit_square(), points_above(3, 21), 1)), std::pair(0.9, 0.9));
  EXPECT_EQ(as_pair(joining_distance(unit_square(), points_above(3, 21), 2)), std::pair(1.0, 1.8));
}

TEST(JoiningDistance, IsHalfOfTheToleranceWhereNothingCanBeMeasured) {
  EXPECT_EQ(as_pair(joining_distance({}, points_above(1, 900), 1)), std::pair(0.5, 0.9));
  EXPECT_EQ(as_pair(joining_distance(unit_square(), {}, 1)), std::pair(0.5, 0.9));
  EXPECT_EQ(as_pair(joining_distance(unit_square(), points_above(1, 900), 1, [] { return true; })),
            std::pair(0.5, 0.9));
}

TEST(JoiningDistance, MeasuresAnEvenPartOfAllPoints) {
  const std::vector<Point> points = points_above(120, 300);
  const std::vector<double> sampled = sampled_distances(unit_square(), points, 0.5, nullptr);
  ASSERT_EQ(sampled.size(), 40'000u);
  const ExactMesh exact(unit_square().view());
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    const double distance = exact.distance(points[3 * i]).upper;
    if (distance > 0.5) {
      EXPECT_EQ(sampled[i], distance);
    } else {
      EXPECT_LE(sampled[i], 0.5);
    }
  }
  EXPECT_EQ(share_beyond(sampled, 0.5), 0.3);
}

}  // namespace
}  // namespace emax::test
