#include "host/tiles/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "host/geometry/box_pairs.h"

namespace emax::test {
namespace {

std::vector<Bounds> drawn_boxes(std::size_t count, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> place(-1, 1), side(0, 0.2);
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Point lower(place(generator), place(generator), place(generator));
    boxes.push_back({lower, lower + Point(side(generator), side(generator), side(generator))});
  }
  return boxes;
}

TEST(BoxTree, FindsWhatBruteForceFinds) {
  std::mt19937_64 generator(3);
  for (const std::size_t count : {1u, 16u, 17u, 500u}) {
    std::vector<Bounds> boxes = drawn_boxes(count, generator);
    if (count > 1) boxes.back() = boxes.front();  // equal ones are found too
    const BoxTree tree(static_cast<std::uint32_t>(count),
                       [&boxes](std::uint32_t i) { return boxes[i]; });
    for (const Bounds& asked : drawn_boxes(50, generator)) {
      std::vector<std::uint32_t> expected, found;
      for (std::uint32_t i = 0; i < count; ++i) {
        if (overlap(boxes[i], asked)) expected.push_back(i);
      }
      tree.for_each(asked, [&](std::uint32_t i) { found.push_back(i); });
      std::ranges::sort(found);
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(BoxTree, MayBeEmpty) {
  const BoxTree tree(0, [](std::uint32_t) { return Bounds{}; });
  EXPECT_TRUE(tree.empty());
  tree.for_each({Point::Zero(), Point::Ones()}, [](std::uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace emax::test
