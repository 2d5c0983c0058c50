#include "host/tiles/tile_points.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

// Every point one by one.
std::vector<NumberedPoint> brute_force(const std::vector<NumberedPoint>& points,
                                       std::span<const Bounds> boxes) {
  std::vector<NumberedPoint> found;
  for (const NumberedPoint& p : points) {
    const bool is_within = std::ranges::any_of(boxes, [&p](const Bounds& box) {
      return (box.lower.array() <= p.position.array()).all() &&
             (p.position.array() <= box.upper.array()).all();
    });
    if (is_within) found.push_back(p);
  }
  return found;
}

std::vector<std::uint64_t> numbers_of(const std::vector<NumberedPoint>& points) {
  std::vector<std::uint64_t> numbers;
  for (const NumberedPoint& p : points) numbers.push_back(p.number);
  return numbers;
}

class TilePointsTest : public testing::Test {
 protected:
  TilePointsTest() {
    std::uniform_real_distribution<double> at(0, 10);
    for (std::uint32_t i = 0; i < 20000; ++i) {
      points_.emplace_back(std::round(8 * at(generator_)) / 8, at(generator_), at(generator_) / 10);
      numbers_.push_back(3 * i + i % 2);  // as where points of a file are left out
      if (i % 7 == 3) {
        excluded_.push_back(numbers_.back());
      } else {
        kept_.push_back({points_.back(), numbers_.back()});
      }
    }
  }

  std::vector<Bounds> boxes(std::size_t count, double size) {
    std::uniform_real_distribution<double> at(-1, 11), side(0, size);
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const Point corner(std::round(8 * at(generator_)) / 8, at(generator_), 0);
      boxes.push_back({corner, corner + Point(side(generator_), side(generator_), 0.5)});
    }
    return boxes;
  }

  void expect_as_brute_force(const TilePoints& asked) {
    EXPECT_EQ(asked.count(), kept_.size());
    EXPECT_GT(asked.end(), kept_.back().number);
    for (const auto& [count, size] : {std::pair{0u, 1.0}, {1u, 20.0}, {40u, 0.3}, {300u, 0.1}}) {
      const std::vector<Bounds> of = boxes(count, size);
      const std::vector<NumberedPoint> found = asked.within(of);
      ASSERT_EQ(numbers_of(found), numbers_of(brute_force(kept_, of)));
      for (const NumberedPoint& p : found) {
        const auto at = std::ranges::lower_bound(numbers_, p.number);
        EXPECT_EQ(p.position, points_[static_cast<std::size_t>(at - numbers_.begin())]);
      }
    }
    std::vector<bool> seen(asked.end());
    std::vector<std::uint32_t> expected;
    for (const NumberedPoint& p : kept_) {
      if (p.number % 5 == 0) {
        expected.push_back(static_cast<std::uint32_t>(p.number));
      } else {
        seen[p.number] = true;
      }
    }
    EXPECT_EQ(asked.unseen(seen), expected);
    EXPECT_EQ(asked.bounds().lower, bounds_of(points_).lower);
    EXPECT_EQ(asked.bounds().upper, bounds_of(points_).upper);
  }

  std::mt19937_64 generator_{7};
  std::vector<Point> points_;
  std::vector<std::uint32_t> numbers_, excluded_;
  std::vector<NumberedPoint> kept_;
};

TEST_F(TilePointsTest, InMemoryAreThoseOfBruteForce) {
  expect_as_brute_force(PointsInMemory(points_, excluded_, numbers_));
}

TEST_F(TilePointsTest, InFilesAreThoseOfBruteForce) {
  const TemporaryFolder folder;
  const CloudSource source = {normalization_of(points_), [this](const CloudSource::Take& take) {
                                for (std::size_t i = points_.size(); i-- > 0;) {
                                  take(std::span(points_).subspan(i, 1), numbers_[i]);
                                }
                              }};
  const CloudPartition partition(source, 1500, folder.path());
  ASSERT_GT(partition.parts().size(), 5u);
  expect_as_brute_force(PointsInFiles(partition, excluded_, 3));
}

}  // namespace
}  // namespace emax::test
