#include "host/geometry/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "grid_point.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/triangle_mesh.h"
#include "host/geometry/triangle_pair.h"

namespace emax::test {
namespace {

// On a grid, so that triangles touch, have corners in common, or have no area.
TriangleMesh soup(std::size_t triangles, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::size_t v = 0; v < triangles; ++v) mesh.vertices.push_back(grid_point(random, 9));
  for (std::size_t t = 0; t < triangles; ++t) {
    Triangle& made = mesh.triangles.emplace_back();
    for (std::uint32_t& v : made) {
      v = static_cast<std::uint32_t>(random.below(static_cast<std::uint32_t>(triangles)));
    }
  }
  return mesh;
}

SelfIntersections all_against_all(const MeshView& mesh) {
  SelfIntersections found;
  std::vector<std::uint32_t> solid;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Point, 3> corners = mesh.corners(t);
    const Point normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (normal.isZero(0)) {  // exact for such small whole numbers
      ++found.flat;
    } else {
      solid.push_back(t);
    }
  }
  std::vector<std::uint8_t> meets(mesh.triangles.size());
  for (std::size_t i = 0; i < solid.size(); ++i) {
    for (std::size_t j = i + 1; j < solid.size(); ++j) {
      if (!intersect_beyond_shared(mesh, solid[i], solid[j])) continue;
      ++found.pairs;
      meets[solid[i]] = meets[solid[j]] = 1;
    }
  }
  for (std::uint32_t t = 0; t < meets.size(); ++t) {
    if (meets[t] != 0) found.triangles.push_back(t);
  }
  return found;
}

TEST(SelfIntersections, SlabsAndThreadsFindWhatAllAgainstAllFinds) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const TriangleMesh mesh = soup(200, seed);
    const SelfIntersections expected = all_against_all(mesh.view());
    ASSERT_GT(expected.pairs, 100u);
    ASSERT_GT(expected.flat, 0u);
    ASSERT_LT(expected.triangles.size(), mesh.triangles.size());
    for (const std::size_t slab : {1u, 7u, 60u, 1000u}) {
      for (const std::size_t threads : {1u, 3u}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", slab " + std::to_string(slab));
        const SelfIntersections found = self_intersections(mesh.view(), threads, slab);
        EXPECT_EQ(found.pairs, expected.pairs);
        EXPECT_EQ(found.triangles, expected.triangles);
        EXPECT_EQ(found.flat, expected.flat);
      }
    }
  }
}

TEST(SelfIntersections, NothingHasNone) {
  EXPECT_EQ(self_intersections({{}, {}}).pairs, 0u);
  EXPECT_EQ(self_intersections({{}, {}}, 2, 1).pairs, 0u);
}

TEST(EdgeSides, AreTheSameHoweverFewAreHeld) {
  const TriangleMesh mesh = soup(300, 4);
  using Side = std::tuple<std::size_t, std::size_t, std::uint32_t, bool>;
  const auto edges = [&](std::size_t held) {
    std::vector<std::vector<Side>> all;
    EdgeSides(mesh.view(), held).for_each_edge([&](std::span<const EdgeSide> sides) {
      all.emplace_back();
      for (const EdgeSide& s : sides) {
        all.back().emplace_back(s.lower_corner, s.upper_corner, s.upper, s.ascends);
      }
    });
    return all;
  };
  const auto whole = edges(EdgeSides::kMostHeld);
  EXPECT_GT(whole.size(), 500u);
  for (const std::size_t held : {1u, 2u, 10u, 100u}) EXPECT_EQ(edges(held), whole);
}

}  // namespace
}  // namespace emax::test
