#include "host/tiles/space_partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>
#include <vector>

namespace emax::test {
namespace {

std::vector<SpaceCell> cells(std::size_t count, int spread, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_int_distribution<int> at(0, spread - 1);
  std::vector<SpaceCell> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.emplace_back(at(generator), at(generator), at(generator));
  }
  return all;
}

bool holds(const SpacePartition::Part& part, const SpaceCell& cell) {
  return (cell >= part.first).all() && (cell < part.last).all();
}

TEST(SpaceCell, GoesFromOneEndOfTheCubeToTheOther) {
  EXPECT_TRUE((space_cell({-1, 0, 1}) == SpaceCell(0, kSpaceCells / 2, kSpaceCells - 1)).all());
  for (const float x : {-1.0f, -0.3f, 0.0f, 0.123456f, 0.9999999f}) {
    const int cell = space_cell({x, 0, 0}).x();
    EXPECT_LE(space_plane(cell), static_cast<double>(x));
    EXPECT_GT(space_plane(cell + 1), static_cast<double>(x));
  }
}

TEST(SpaceCount, DoesNotDependOnOrderOrThreads) {
  const std::vector<SpaceCell> all = cells(20000, kSpaceCells, 1);
  SpaceCount forward(1000), backward(1000), shared(1000);
  for (std::size_t i = 0; i < all.size(); i += 100) {
    forward.add(std::span(all).subspan(i, 100));
    backward.add(std::span(all).subspan(all.size() - i - 100, 100));
  }
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] { shared.add(std::span(all).subspan(5000 * t, 5000)); });
    }
  }
  ASSERT_LE(forward.entries().size(), 1000u);
  for (const SpaceCount* other : {&backward, &shared}) {
    EXPECT_EQ(other->level(), forward.level());
    ASSERT_EQ(other->entries().size(), forward.entries().size());
    for (std::size_t i = 0; i < forward.entries().size(); ++i) {
      EXPECT_TRUE((other->entries()[i].cell == forward.entries()[i].cell).all());
      EXPECT_EQ(other->entries()[i].points, forward.entries()[i].points);
    }
  }
}

TEST(SpaceCount, HasTheFinestCellsThatItsLimitAllows) {
  const std::vector<SpaceCell> all = cells(5000, kSpaceCells, 2);
  SpaceCount count(1000);
  count.add(all);
  const auto occupied = [&](int level) {
    std::vector<std::array<int, 3>> coarse;
    for (const SpaceCell& c : all) {
      coarse.push_back({c.x() >> level, c.y() >> level, c.z() >> level});
    }
    std::ranges::sort(coarse);
    return std::unique(coarse.begin(), coarse.end()) - coarse.begin();
  };
  EXPECT_LE(occupied(count.level()), 1000);
  EXPECT_GT(occupied(count.level() - 1), 1000);
}

TEST(SpacePartition, GivesEveryPointToTheOnePartThatHoldsIt) {
  for (const int spread : {4, 1000, kSpaceCells}) {
    const std::vector<SpaceCell> all = cells(10000, spread, 3);
    SpaceCount count;
    count.add(all);
    const SpacePartition space(count, 700);
    std::vector<std::uint64_t> points(space.parts().size(), 0);
    for (const SpaceCell& cell : all) {
      const std::size_t part = space.part_of(cell);
      ++points[part];
      EXPECT_EQ(std::ranges::count_if(space.parts(), [&](const auto& p) { return holds(p, cell); }),
                1);
      EXPECT_TRUE(holds(space.parts()[part], cell));
    }
    for (std::size_t part = 0; part < points.size(); ++part) {
      EXPECT_EQ(space.parts()[part].points, points[part]);
      EXPECT_LE(points[part], 700u);
    }
    const SpacePartition again({space.nodes().begin(), space.nodes().end()}, points);
    for (const SpaceCell& cell : all) EXPECT_EQ(again.part_of(cell), space.part_of(cell));
  }
}

// A stray point far away leaves the others in one cell of any grid of a fixed size.
TEST(SpacePartition, CutsWhatAStrayPointMakesSmall) {
  std::vector<SpaceCell> all = cells(5000, 64, 4);
  all.emplace_back(SpaceCell::Constant(kSpaceCells - 1));
  SpaceCount count(300);
  count.add(all);
  const SpacePartition space(count, 1000);
  for (const SpacePartition::Part& part : space.parts()) EXPECT_LE(part.points, 1000u);
}

TEST(SpacePartition, LeavesTogetherWhatIsInOneCell) {
  SpaceCount count;
  count.add(std::vector<SpaceCell>(5000, SpaceCell(7, 8, 9)));
  const SpacePartition space(count, 100);
  ASSERT_EQ(space.parts().size(), 1u);
  EXPECT_EQ(space.parts()[0].points, 5000u);
}

}  // namespace
}  // namespace emax::test
