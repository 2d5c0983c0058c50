#include "host/features/connected_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/host/features/clouds.h"

namespace emax::test {
namespace {

// The twin: in every round all points are compared with all members.
std::vector<std::uint32_t> by_rounds(const Neighbourhoods& near, std::uint32_t first,
                                     const std::vector<bool>& accepted) {
  std::vector<std::uint32_t> set = {first};
  for (bool grows = true; grows;) {
    grows = false;
    for (std::uint32_t i = 0; i < accepted.size(); ++i) {
      if (!accepted[i] || std::ranges::count(set, i) > 0) continue;
      const bool neighbours = std::ranges::any_of(set, [&](std::uint32_t member) {
        const auto of = near.of(member);
        return std::count(of.begin(), of.end(), i) > 0;
      });
      if (neighbours) set.push_back(i), grows = true;
    }
  }
  std::ranges::sort(set);
  return set;
}

TEST(ConnectedPoints, AreThoseOfTheQuadraticTwin) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    Random random(named_seed("connected", seed));
    std::vector<Point> cloud;
    for (std::size_t i = 0; i < 300; ++i) cloud.push_back(random.point(-1, 1));
    const Neighbourhoods near = neighbourhoods_of(cloud, PointTree(cloud), 6, 0.3, 0.1);
    std::vector<bool> accepted;
    for (std::size_t i = 0; i < cloud.size(); ++i) accepted.push_back(random.below(3) > 0);
    ConnectedPoints connected(near);
    std::vector<std::uint32_t> set;
    for (int start = 0; start < 5; ++start) {
      const auto first = static_cast<std::uint32_t>(random.below(cloud.size()));
      for (const bool asks_again : {false, true}) {
        connected.gather(
            first, [&](std::uint32_t i) { return accepted[i]; }, set, asks_again);
        std::ranges::sort(set);
        EXPECT_EQ(set, by_rounds(near, first, accepted)) << "seed " << seed;
      }
    }
  }
}

TEST(Neighbourhoods, AreTheSameForAnyNumberOfThreads) {
  Random random(named_seed("neighbourhoods", 1));
  std::vector<Point> cloud;
  for (std::size_t i = 0; i < 20'000; ++i) cloud.push_back(random.point(-1, 1));
  const PointTree tree(cloud);
  const Neighbourhoods one = neighbourhoods_of(cloud, tree, 12, 0.3, 0.01, 1);
  const Neighbourhoods three = neighbourhoods_of(cloud, tree, 12, 0.3, 0.01, 3);
  EXPECT_EQ(one.neighbours, three.neighbours);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_EQ(one.points[i].normal, three.points[i].normal);
    ASSERT_EQ(one.points[i].covariance, three.points[i].covariance);
  }
}

// Where more points coincide than neighbours are asked for, none is its own neighbour.
TEST(Neighbourhoods, DoNotHaveThePointItself) {
  Random random(named_seed("neighbourhoods", 2));
  std::vector<Point> cloud(30, Point(1, 2, 3));
  for (std::size_t i = 0; i < 100; ++i) cloud.push_back(random.point(-1, 1));
  const Neighbourhoods near = neighbourhoods_of(cloud, PointTree(cloud), 10, 0.3, 0.01);
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const auto of = near.of(i);
    EXPECT_EQ(of.size(), 10u);
    EXPECT_EQ(std::count(of.begin(), of.end(), i), 0) << i;
  }
}

}  // namespace
}  // namespace emax::test
