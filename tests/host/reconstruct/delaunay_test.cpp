#include "host/reconstruct/delaunay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using Place = Eigen::Vector2d;

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

double doubled_area(const Place& a, const Place& b, const Place& c) {
  const Place u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

double radius(const Place& a, const Place& b, const Place& c) {
  return (a - b).norm() * (b - c).norm() * (c - a).norm() / (2 * std::abs(doubled_area(a, b, c)));
}

Place centre(const Place& a, const Place& b, const Place& c) {
  const Place u = b - a, v = c - a;
  const double d = 2 * doubled_area(a, b, c);
  return a + Place(v.y() * u.squaredNorm() - u.y() * v.squaredNorm(),
                   u.x() * v.squaredNorm() - v.x() * u.squaredNorm()) /
                 d;
}

std::vector<Place> scattered(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  std::vector<Place> places;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = random.uniform(-3, 5);
    places.emplace_back(x, random.uniform(-1, 1));
  }
  return places;
}

std::set<Triangle> sorted(const std::vector<Triangle>& triangles) {
  std::set<Triangle> all;
  for (Triangle t : triangles) {
    std::ranges::sort(t);
    EXPECT_TRUE(all.insert(t).second);
  }
  return all;
}

// All triples whose circle holds no other place.
std::set<Triangle> by_brute_force(const std::vector<Place>& places, double reach) {
  std::set<Triangle> found;
  const auto n = static_cast<std::uint32_t>(places.size());
  for (std::uint32_t a = 0; a < n; ++a) {
    for (std::uint32_t b = a + 1; b < n; ++b) {
      for (std::uint32_t c = b + 1; c < n; ++c) {
        const Place middle = centre(places[a], places[b], places[c]);
        const double r = radius(places[a], places[b], places[c]);
        const bool is_empty = std::ranges::none_of(
            places, [&](const Place& p) { return (p - middle).norm() < r * (1 - 1e-9); });
        if (is_empty && r <= reach) found.insert({a, b, c});
      }
    }
  }
  return found;
}

double area_of(const std::vector<Place>& places, const std::vector<Triangle>& triangles) {
  double area = 0;
  for (const Triangle& t : triangles) {
    const double doubled = doubled_area(places[t[0]], places[t[1]], places[t[2]]);
    EXPECT_GT(doubled, 0);
    area += doubled / 2;
  }
  return area;
}

TEST(AlphaShape, IsThatOfBruteForce) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const std::vector<Place> places = scattered(60, seed);
    for (const double reach : {0.2, 0.5, 1.0, kEverywhere}) {
      const std::vector<Triangle> triangles = alpha_shape(places, reach);
      EXPECT_EQ(sorted(triangles), by_brute_force(places, reach)) << reach;
      area_of(places, triangles);
    }
  }
}

TEST(AlphaShape, CoversAGridOnce) {
  std::vector<Place> places;
  constexpr int kSide = 12;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) places.emplace_back(0.5 * i - 7, 0.5 * j + 100);
  }
  const std::vector<Triangle> triangles = alpha_shape(places, 0.36);
  EXPECT_EQ(triangles.size(), 2u * (kSide - 1) * (kSide - 1));
  EXPECT_NEAR(area_of(places, triangles), 0.25 * (kSide - 1) * (kSide - 1), 1e-6);
  EXPECT_TRUE(alpha_shape(places, 0.35).empty());
}

TEST(AlphaShape, LeavesWideGapsOpen) {
  std::vector<Place> places = scattered(400, 5);
  std::erase_if(places, [](const Place& p) { return std::abs(p.x()) < 1; });
  for (const Triangle& t : alpha_shape(places, 0.9)) {
    const bool left = places[t[0]].x() < 0;
    EXPECT_EQ(places[t[1]].x() < 0, left);
    EXPECT_EQ(places[t[2]].x() < 0, left);
  }
}

TEST(AlphaShape, TakesTheFirstOfPlacesThatCoincide) {
  std::vector<Place> places = scattered(50, 6);
  const std::vector<Triangle> alone = alpha_shape(places, kEverywhere);
  places.insert(places.end(), places.begin(), places.end());
  EXPECT_EQ(alpha_shape(places, kEverywhere), alone);
}

TEST(AlphaShape, OfFewOrCollinearPlacesIsEmpty) {
  EXPECT_TRUE(alpha_shape({}, kEverywhere).empty());
  const std::array two = {Place(0, 0), Place(1, 1)};
  EXPECT_TRUE(alpha_shape(two, kEverywhere).empty());
  std::vector<Place> line, same(9, Place(3, -2));
  for (int i = 0; i < 9; ++i) line.emplace_back(i, 2 * i);
  EXPECT_TRUE(alpha_shape(line, kEverywhere).empty());
  EXPECT_TRUE(alpha_shape(same, kEverywhere).empty());
}

}  // namespace
}  // namespace emax::test
