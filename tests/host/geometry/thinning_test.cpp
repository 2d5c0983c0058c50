#include "host/geometry/thinning.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

std::vector<std::uint32_t> brute_force(std::span<const Point> points, double radius) {
  std::vector<std::uint32_t> taken;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const bool is_near = std::ranges::any_of(taken, [&](std::uint32_t t) {
      return (points[t] - points[i]).squaredNorm() < radius * radius;
    });
    if (!is_near) taken.push_back(i);
  }
  return taken;
}

TEST(Thinning, TakesWhatBruteForceTakes) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(named_seed("thinning", seed));
    const double scale = std::pow(10, random.uniform(-3, 3));
    const Point middle = seed % 3 == 0 ? Point(1e6, -4e6, 100) : Point(0, 0, 0);
    std::vector<Point> points;
    for (int i = 0; i < 600; ++i) {
      Point p = random.point(-1, 1);
      // On planes and with points that repeat; far alone in some.
      if (seed % 2 == 0) p = (p * 8).array().round() / 8;
      if (seed % 5 == 0 && i % 100 == 0) p *= 1e7;
      points.push_back(middle + p * scale);
    }
    for (const double radius : {0.01, 0.125, 0.5, 4.0}) {
      EXPECT_EQ(thinned(points, radius * scale), brute_force(points, radius * scale))
          << "seed " << seed << ", radius " << radius;
    }
  }
}

TEST(Thinning, LeavesAboutTheWantedNumber) {
  Random random(named_seed("thinning of a square", 1));
  std::vector<Point> points;
  for (int i = 0; i < 40'000; ++i) {
    points.push_back({random.uniform(0, 1), random.uniform(0, 1), 0});
  }
  const double spacing = 1 / std::sqrt(40'000.0);
  for (const std::size_t wanted : {500u, 2000u, 10'000u}) {
    const std::size_t left =
        thinned(points, thinning_radius(spacing, points.size(), wanted)).size();
    EXPECT_GT(left, wanted * 6 / 10);
    EXPECT_LT(left, wanted * 13 / 10);
  }
}

TEST(Thinning, OfNothingIsNothing) { EXPECT_TRUE(thinned({}, 1).empty()); }

}  // namespace
}  // namespace emax::test
