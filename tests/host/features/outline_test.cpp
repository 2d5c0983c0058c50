#include "host/features/outline.h"

#include <gtest/gtest.h>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using Flat = std::vector<Eigen::Vector2d>;

// Points of the unit square for which `has` is true.
template <class Has>
Flat spread(std::size_t count, std::uint64_t seed, const Has& has) {
  Random random(named_seed("outline", seed));
  Flat points;
  while (points.size() < count) {
    const Point p = (random.point(-1, 1) + Point::Ones()) / 2;
    if (has(p.x(), p.y())) points.emplace_back(p.x(), p.y());
  }
  return points;
}

TEST(Outline, OfASquareHasItsArea) {
  const Outline outline = outline_of(spread(5000, 1, [](double, double) { return true; }));
  EXPECT_NEAR(outline.area, 1, 0.05);
  EXPECT_LE(outline.polygon.size(), 12u);
}

TEST(Outline, FollowsACornerThatLooksInwards) {
  const auto is_l = [](double x, double y) { return x < 0.4 || y < 0.4; };
  EXPECT_NEAR(outline_of(spread(8000, 2, is_l)).area, 0.64, 0.05);
}

TEST(Outline, LeavesOpeningsIn) {
  const auto frame = [](double x, double y) {
    return std::abs(x - 0.5) > 0.2 || std::abs(y - 0.5) > 0.2;
  };
  EXPECT_NEAR(outline_of(spread(8000, 3, frame)).area, 1, 0.05);
}

TEST(Outline, IsThatOfTheGreatestPart) {
  const auto two = [](double x, double) { return x < 0.6 || x > 0.8; };
  EXPECT_NEAR(outline_of(spread(8000, 4, two)).area, 0.6, 0.05);
}

TEST(Outline, OfAlmostNothingIsEmpty) {
  EXPECT_TRUE(outline_of(Flat{}).polygon.empty());
  EXPECT_TRUE(outline_of(Flat{{0, 0}, {1, 1}}).polygon.empty());
  EXPECT_TRUE(outline_of(Flat(100, {3, 4})).polygon.empty());
  EXPECT_TRUE(outline_of(Flat{{0, 0}, {1, 0}, {2, 0}, {5, 0}}).polygon.empty());
  EXPECT_EQ(outline_of(Flat{{0, 0}, {1, 1}, {1e6, 1e-6}}).area, 0);
}

}  // namespace
}  // namespace emax::test
