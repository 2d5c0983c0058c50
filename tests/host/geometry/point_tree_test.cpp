#include "host/geometry/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

std::vector<PointTree::Neighbour> brute_force(std::span<const Point> points, const Point& p,
                                              std::size_t k) {
  std::vector<PointTree::Neighbour> all;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    all.push_back({(points[i] - p).squaredNorm(), i});
  }
  std::ranges::sort(all);
  all.resize(std::min(k, all.size()));
  return all;
}

TEST(PointTree, FindsWhatBruteForceFinds) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(named_seed("point tree", seed));
    std::vector<Point> points;
    const std::size_t n = 1 + random.below(400);
    for (std::size_t i = 0; i < n; ++i) {
      Point p = random.point(-1, 1);
      // On a coarse grid, so that distances and points repeat.
      if (seed % 2 == 0) p = (p * 4).array().round();
      points.push_back(p);
    }
    const PointTree tree(points);
    std::vector<PointTree::Neighbour> found;
    for (int query = 0; query < 30; ++query) {
      const Point p = query % 3 == 0 ? points[random.below(n)] : random.point(-2, 2);
      const std::size_t k = random.below(12);
      tree.nearest(p, k, found);
      EXPECT_EQ(found, brute_force(points, p, k)) << "seed " << seed;
    }
  }
}

TEST(PointTree, HoldsNoPointAtAll) {
  std::vector<PointTree::Neighbour> found;
  PointTree({}).nearest(Point::Zero(), 3, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace emax::test
