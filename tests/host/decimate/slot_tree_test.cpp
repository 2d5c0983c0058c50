#include "host/decimate/slot_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "host/decimate/spatial_order.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

// Nearest triangles and overlapping boxes, with and without the tree.
void expect_exact(const SlotTree& tree, const EditableMesh& mesh, Random& random, double reach) {
  for (int i = 0; i < 60; ++i) {
    const Point p = mesh.position(0) + reach * random.point(-1, 1);
    SlotTree::Nearest best{kNoIndex, kAnywhere};
    const Bounds box = {p - Point::Constant(0.1 * reach), p + Point::Constant(0.1 * reach)};
    std::vector<std::uint32_t> overlapping, found;
    for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
      if (!mesh.alive(slot)) continue;
      const double squared = squared_distance(p, mesh.corners(slot));
      if (squared < best.squared_distance) best = {slot, squared};
      if (overlap(bounds_of(mesh.corners(slot)), box)) overlapping.push_back(slot);
    }
    const SlotTree::Nearest nearest = tree.nearest(mesh, p, kAnywhere);
    ASSERT_EQ(nearest.slot, best.slot);
    ASSERT_EQ(nearest.squared_distance, best.squared_distance);
    const std::uint32_t hint = random.below(static_cast<std::uint32_t>(mesh.slots()));
    ASSERT_EQ(tree.nearest(mesh, p, kAnywhere, hint).slot, best.slot);
    ASSERT_EQ(tree.nearest(mesh, p, 0.99 * best.squared_distance).slot, kNoIndex);
    tree.for_each_overlap(tree.rounded(box), [&](std::uint32_t slot, const SlotTree::Box&) {
      found.push_back(slot);
      return true;
    });
    std::ranges::sort(found);
    ASSERT_TRUE(std::ranges::includes(found, overlapping));
  }
}

TEST(SlotTree, IsExactAtEveryScaleAndPlace) {
  for (const double scale : {1e-30, 1.0, 1e25}) {
    for (const double away : {0.0, 1e5}) {
      TriangleMesh mesh = bumpy(12, 18);
      for (Point& p : mesh.vertices) p = scale * (p + Point::Constant(away));
      const EditableMesh editable(mesh);
      Random random(3);
      expect_exact(SlotTree(editable), editable, random, 2 * scale);
    }
  }
}

// Slots freed, moved and added, all of them at one place at last: the tree that grows says so.
TEST(SlotTree, IsExactAsTheMeshChanges) {
  EditableMesh mesh(bumpy(12, 18));
  SlotTree tree(mesh);
  Random random(4);
  bool outgrown = false;
  for (int i = 0; i < 1500; ++i) {
    std::uint32_t slot = 0;
    do slot = random.below(static_cast<std::uint32_t>(mesh.slots()));
    while (!mesh.alive(slot));
    const Triangle t = mesh.triangle(slot);
    if (i % 3 == 0) {
      const auto [a, b, c] = mesh.corners(slot);
      const std::uint32_t v = mesh.add_vertex((a + b + c) / 3 + 0.01 * random.point(-1, 1));
      mesh.clear(slot);
      tree.update(mesh, slot);
      for (const Triangle& part : {Triangle{t[0], t[1], v}, Triangle{t[1], t[2], v}}) {
        const std::uint32_t added = mesh.add_slot();
        mesh.set(added, part);
        tree.update(mesh, added);
      }
    } else if (i % 3 == 1) {
      mesh.clear(slot);
      tree.update(mesh, slot);
    } else {
      mesh.move(t[0], mesh.position(t[0]) + 0.05 * random.point(-1, 1));
      mesh.for_each_slot_at(t[0], [&](std::uint32_t s) { tree.update(mesh, s); });
    }
    if (i % 250 == 249) expect_exact(tree, mesh, random, 1.5);
    if (HasFatalFailure()) return;
    if (!tree.outgrown(mesh)) continue;
    outgrown = true;
    tree.rebuild(mesh);
  }
  EXPECT_TRUE(outgrown);
}

TEST(SlotTree, HoldsNothingOfAnEmptyMesh) {
  EditableMesh mesh({});
  SlotTree tree(mesh);
  EXPECT_EQ(tree.nearest(mesh, Point::Zero(), kAnywhere).slot, kNoIndex);
}

TEST(SpatialOrder, IsAPermutationThatKeepsWhatIsNearTogether) {
  const TriangleMesh mesh = bumpy(40, 60);
  std::vector<std::uint32_t> order = spatial_order(mesh.vertices);
  double along = 0, along_rings = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    along += (mesh.vertices[order[i]] - mesh.vertices[order[i - 1]]).norm();
    along_rings += (mesh.vertices[i] - mesh.vertices[(i * 601) % order.size()]).norm();
  }
  EXPECT_LT(along, 0.2 * along_rings);
  std::ranges::sort(order);
  for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  EXPECT_TRUE(spatial_order({}).empty());
}

TEST(SpatialOrder, KeepsTheTriangles) {
  TriangleMesh mesh = bumpy(10, 16);
  mesh.vertices.push_back({9, 9, 9});  // unused
  const TriangleMesh ordered = spatially_ordered(mesh);
  EXPECT_EQ(ordered.vertices.size() + 1, mesh.vertices.size());
  using Corners = std::array<std::array<double, 3>, 3>;
  const auto shapes = [](const TriangleMesh& of) {
    std::vector<Corners> all;
    for (std::size_t t = 0; t < of.triangles.size(); ++t) {
      Corners corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const Point& p = of.vertices[of.triangles[t][i]];
        corners[i] = {p[0], p[1], p[2]};
      }
      std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
      all.push_back(corners);
    }
    std::ranges::sort(all);
    return all;
  };
  EXPECT_EQ(shapes(ordered), shapes(mesh));
}

}  // namespace
}  // namespace emax::test
