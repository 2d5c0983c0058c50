#include "host/block_search/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/engine/prepared_cloud.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(TriangleTree, EveryLeafHoldsOneTriangleAndEveryBoxItsChildren) {
  for (const test::Stimulus& s : test::all_stimuli(42)) {
    SCOPED_TRACE(s.name + ", seed 42");
    const Normalization normalization = normalization_of(s.cloud);
    const TriangleTree tree(s.mesh(), normalization);
    std::vector<int> seen(s.triangles.size(), 0);
    for (const TriangleTree::Node& node : tree.nodes()) {
      if (!node.is_leaf()) {
        EXPECT_TRUE(node.box.contains(tree.left(node).box));
        EXPECT_TRUE(node.box.contains(tree.right(node).box));
        EXPECT_EQ(tree.left(node).first, node.first);
        EXPECT_EQ(tree.left(node).last, tree.right(node).first);
        EXPECT_EQ(tree.right(node).last, node.last);
        continue;
      }
      const std::uint32_t triangle = tree.records()[node.first].tag & ~kSegmentFlag;
      ++seen.at(triangle);
      for (const Point& corner : s.mesh().corners(triangle)) {
        EXPECT_TRUE(node.box.contains(normalization.apply(corner)));
      }
    }
    EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; }));
  }
}

// The kd-tree's point location and the AABB-tree are one structure: a triangle's own centre leads
// to a node that holds it (or one whose centre lies on the same plane).
TEST(TriangleTree, HintLeadsToTheNodeOfATriangle) {
  const test::Stimulus s = test::bumpy_sphere(30, 40, 10, 43);
  const Normalization normalization = normalization_of(s.cloud);
  const TriangleTree tree(s.mesh(), normalization);
  std::size_t found = 0;
  for (const TriangleTree::Node& node : tree.nodes()) {
    if (!node.is_leaf()) continue;
    const TriangleTree::Node& hint = tree.hint(node.box.center(), 8);
    EXPECT_GE(hint.last - hint.first, 8u);
    EXPECT_LT(hint.last - hint.first, 17u);
    found += hint.first <= node.first && node.first < hint.last;
  }
  EXPECT_GT(found, s.triangles.size() * 95 / 100);
}

TEST(TriangleTree, RefusesAMeshWithoutTriangles) {
  EXPECT_THROW(TriangleTree({}, Normalization{}), Error);
}

}  // namespace
}  // namespace emax
