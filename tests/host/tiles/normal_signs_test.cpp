#include "host/tiles/normal_signs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace emax::test {
namespace {

constexpr std::uint32_t kParts = 12;
constexpr std::uint64_t kPoints = 360;

Eigen::Vector3f outward(std::uint64_t number) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(number) / kPoints;
  return Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>();
}

// A circle in twelve arcs. Every part knows its own points and, as another component, those of its
// neighbours that lie within `around` of it; each component has a sign of its own.
std::vector<PartNormals> circle(std::uint64_t around, std::mt19937_64& generator,
                                std::vector<std::vector<float>>& made) {
  std::vector<PartNormals> parts(kParts);
  made.assign(kParts, {});
  for (std::uint32_t part = 0; part < kParts; ++part) {
    made[part] = {generator() % 2 == 0 ? 1.0f : -1.0f, generator() % 2 == 0 ? 1.0f : -1.0f};
    parts[part].components.resize(1);
    std::map<std::uint64_t, BorderNormal> known;
    const std::uint64_t first = part * kPoints / kParts, end = (part + 1) * kPoints / kParts;
    for (std::uint64_t n = first; n < end; ++n) {
      const Eigen::Vector3f normal = made[part][0] * outward(n);
      parts[part].own.push_back({n, part, 0, normal});
      for (int axis = 0; axis < 3; ++axis) {
        const auto side = static_cast<std::size_t>(2 * axis);
        const float at = outward(n)[axis];
        parts[part].components[0][side].take({at, normal[axis], n});
        parts[part].components[0][side + 1].take({-at, -normal[axis], n});
      }
    }
    for (std::uint64_t step = 1; step <= around; ++step) {
      for (const std::uint64_t n :
           {(first + kPoints - step) % kPoints, (end + step - 1) % kPoints}) {
        known[n] = {n, static_cast<std::uint32_t>(n * kParts / kPoints), 0,
                    made[part][0] * outward(n)};
      }
    }
    for (const auto& [number, normal] : known) parts[part].around.push_back(normal);
  }
  return parts;
}

TEST(ConsistentSigns, TurnEveryPartOutward) {
  std::mt19937_64 generator(1);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::vector<float>> made;
    const auto signs = consistent_signs(circle(3, generator, made));
    for (std::uint32_t part = 0; part < kParts; ++part) {
      EXPECT_EQ(signs[part][0], made[part][0]) << part;
    }
  }
}

TEST(ConsistentSigns, FollowMostOfThePointsThatTwoPartsKnow) {
  std::mt19937_64 generator(2);
  std::vector<std::vector<float>> made;
  std::vector<PartNormals> parts = circle(5, generator, made);
  for (PartNormals& part : parts) {
    part.around[0].normal *= -1;  // two of ten
    part.around[7].normal *= -1;
  }
  const auto signs = consistent_signs(parts);
  for (std::uint32_t part = 0; part < kParts; ++part) EXPECT_EQ(signs[part][0], made[part][0]);
}

// Without a common point each is turned outward by itself: here by its extreme point.
TEST(ConsistentSigns, TurnWhatHasNoNeighbourByItself) {
  std::mt19937_64 generator(3);
  std::vector<std::vector<float>> made;
  const auto signs = consistent_signs(circle(0, generator, made));
  for (std::uint32_t part = 0; part < kParts; ++part) EXPECT_EQ(signs[part][0], made[part][0]);
}

TEST(ExtremePoint, IsTheFarthestAndThenTheFirst) {
  ExtremePoint extreme;
  extreme.take({1, 0.5f, 7});
  extreme.take({0, 0.1f, 1});
  EXPECT_EQ(extreme.number, 7u);
  extreme.take({1, 0.2f, 3});
  EXPECT_EQ(extreme.number, 3u);
  extreme.take({1, 0.3f, 9});
  EXPECT_EQ(extreme.number, 3u);
}

}  // namespace
}  // namespace emax::test
