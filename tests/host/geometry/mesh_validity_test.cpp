#include "host/geometry/mesh_validity.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "grid_point.h"
#include "host/geometry/box_pairs.h"
#include "host/geometry/triangle_mesh.h"
#include "host/geometry/triangle_pair.h"

namespace emax::test {
namespace {

MeshValidity check(const std::vector<Point>& vertices, const std::vector<Triangle>& triangles) {
  return check_mesh({vertices, triangles});
}

const std::vector<Point> kTetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Triangle> kTetrahedronFaces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

void expect_counts(const MeshValidity& v, std::array<std::size_t, 8> counts) {
  const std::array<std::size_t, 8> found{v.boundary_edges,
                                         v.non_manifold_edges,
                                         v.non_manifold_vertices,
                                         v.inconsistent_edges,
                                         v.degenerate_triangles,
                                         v.self_intersections,
                                         v.self_intersecting_triangles,
                                         v.components};
  EXPECT_EQ(found, counts);
}

TEST(MeshValidity, ClosedSurfaceIsValid) {
  const MeshValidity v = check(kTetrahedron, kTetrahedronFaces);
  expect_counts(v, {0, 0, 0, 0, 0, 0, 0, 1});
  EXPECT_TRUE(v.valid());
}

TEST(MeshValidity, OpenSheetIsValid) {
  const MeshValidity v =
      check({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  expect_counts(v, {4, 0, 0, 0, 0, 0, 0, 1});
  EXPECT_TRUE(v.valid());
}

TEST(MeshValidity, OneTriangleTurnedRound) {
  std::vector<Triangle> faces = kTetrahedronFaces;
  std::swap(faces[3][0], faces[3][1]);
  const MeshValidity v = check(kTetrahedron, faces);
  expect_counts(v, {0, 0, 0, 3, 0, 0, 0, 1});
  EXPECT_FALSE(v.valid());
}

TEST(MeshValidity, ThreeLeavesOnOneEdge) {
  const MeshValidity v = check({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                               {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  expect_counts(v, {6, 1, 0, 0, 0, 0, 0, 1});
  EXPECT_FALSE(v.valid());
}

TEST(MeshValidity, TwoFansOnOneVertex) {
  const MeshValidity v =
      check({{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {-1, 0, -1}, {0, -1, -1}}, {{0, 1, 2}, {0, 3, 4}});
  expect_counts(v, {6, 0, 1, 0, 0, 0, 0, 2});
  EXPECT_FALSE(v.valid());
}

TEST(MeshValidity, DegenerateTriangles) {
  // No area, exactly; then a repeated index, which takes no part in anything else.
  const MeshValidity line = check({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}, {{0, 1, 2}});
  expect_counts(line, {3, 0, 0, 0, 1, 0, 0, 1});
  EXPECT_FALSE(line.valid());
  std::vector<Triangle> faces = kTetrahedronFaces;
  faces.push_back({1, 1, 2});
  const MeshValidity repeated = check(kTetrahedron, faces);
  expect_counts(repeated, {0, 0, 0, 0, 1, 0, 0, 1});
  EXPECT_FALSE(repeated.valid());
  // The thinnest triangle there is, is none.
  EXPECT_TRUE(check({{0, 0, 0}, {1, 1, 1}, {3, 3, 3.0000000000000004}}, {{0, 1, 2}}).valid());
}

TEST(MeshValidity, SelfIntersections) {
  struct Case {
    std::string reason;
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::size_t pairs;
  };
  const std::vector<Point> base{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const auto with = [&](std::vector<Point> more) {
    more.insert(more.begin(), base.begin(), base.end());
    return more;
  };
  const std::vector<Triangle> apart{{0, 1, 2}, {3, 4, 5}};
  const std::vector<Case> cases{
      {"one pierces the other", with({{1, 1, -1}, {1, 1, 1}, {9, 9, 1}}), apart, 1},
      {"it passes beside the other", with({{3, 3, -1}, {3, 3, 1}, {9, 9, 1}}), apart, 0},
      {"a corner touches the inside", with({{1, 1, 0}, {1, 1, 1}, {1, 2, 1}}), apart, 1},
      {"a corner touches an edge", with({{2, 0, 0}, {2, -1, 1}, {2, -1, -1}}), apart, 1},
      {"equal corners of different index", with({{0, 0, 0}, {-1, 0, 1}, {-1, 0, -1}}), apart, 1},
      {"edges cross in one point", with({{2, 0, 1}, {2, 0, -1}, {2, -2, 0}}), apart, 1},
      {"it ends just above the other", with({{1, 1, 5e-324}, {1, 1, 1}, {1, 2, 1}}), apart, 0},
      {"coplanar and overlapping", with({{1, 1, 0}, {5, 1, 0}, {1, 5, 0}}), apart, 1},
      {"coplanar, one inside the other", with({{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}), apart, 1},
      {"coplanar, one around the other", with({{-9, -9, 0}, {30, -9, 0}, {-9, 30, 0}}), apart, 1},
      {"coplanar and apart", with({{3, 3, 0}, {5, 3, 0}, {3, 5, 0}}), apart, 0},
      {"coplanar, edges on one line that overlap", with({{1, 0, 0}, {3, 0, 0}, {2, -2, 0}}), apart,
       1},
      {"in parallel planes", with({{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}), apart, 0},
      {"a shared vertex and nothing else",
       with({{-1, 0, 1}, {-1, 1, 1}}),
       {{0, 1, 2}, {0, 3, 4}},
       0},
      {"a shared vertex, the far edge pierces",
       with({{2, 2, -1}, {1, 1, 1}}),
       {{0, 1, 2}, {0, 3, 4}},
       1},
      {"a shared vertex, edges on one ray",
       with({{2, 0, 0}, {2, 0, 2}}),
       {{0, 1, 2}, {0, 3, 4}},
       1},
      {"a shared vertex, opposite edges on one line",
       with({{-2, 0, 0}, {-2, 0, 2}}),
       {{0, 1, 2}, {0, 3, 4}},
       0},
      {"a shared vertex, coplanar overlap",
       with({{2, 1, 0}, {1, 2, 0}}),
       {{0, 1, 2}, {0, 3, 4}},
       1},
      {"a shared vertex, coplanar neighbours",
       with({{-1, 0, 0}, {0, -1, 0}}),
       {{0, 1, 2}, {0, 3, 4}},
       0},
      {"a shared edge, flat", with({{4, 4, 0}}), {{0, 1, 2}, {2, 1, 3}}, 0},
      {"a shared edge, folded to an angle", with({{1, 1, 1}}), {{0, 1, 2}, {2, 1, 3}}, 0},
      {"a shared edge, folded right over", with({{1, 1, 0}}), {{0, 1, 2}, {2, 1, 3}}, 1},
      {"the same three corners", base, {{0, 1, 2}, {0, 2, 1}}, 1}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.reason);
    // In either order, all rotations, and far from the origin.
    for (const double offset : {0.0, 1048576.0}) {
      std::vector<Point> vertices = c.vertices;
      if (offset != 0 && c.reason == "it ends just above the other") continue;
      for (Point& p : vertices) p += Point(offset, -offset, offset);
      for (int turn = 0; turn < 9; ++turn) {
        std::vector<Triangle> triangles = c.triangles;
        std::rotate(triangles[0].begin(), triangles[0].begin() + turn % 3, triangles[0].end());
        std::rotate(triangles[1].begin(), triangles[1].begin() + turn / 3, triangles[1].end());
        for (int order = 0; order < 2; ++order) {
          std::swap(triangles[0], triangles[1]);
          const MeshValidity v = check(vertices, triangles);
          EXPECT_EQ(v.self_intersections, c.pairs);
          EXPECT_EQ(v.self_intersecting_triangles, 2 * c.pairs);
          EXPECT_EQ(v.valid(),
                    c.pairs == 0 && v.inconsistent_edges == 0 && v.non_manifold_vertices == 0);
        }
      }
    }
  }
}

TEST(MeshValidity, TwoSpheresThroughEachOther) {
  const Stimulus sphere = bumpy_sphere(24, 32, 0, 1);
  EXPECT_TRUE(check_mesh(sphere.mesh()).valid());
  TriangleMesh both{sphere.vertices, sphere.triangles};
  const auto count = static_cast<std::uint32_t>(sphere.vertices.size());
  for (const Point& p : sphere.vertices) both.vertices.push_back(p + Point(0.71, 0.33, 0.12));
  for (const Triangle& t : sphere.triangles) {
    both.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  const MeshValidity v = check_mesh(both.view());
  EXPECT_EQ(v.components, 2u);
  EXPECT_EQ(v.boundary_edges, 0u);
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < both.triangles.size(); ++i) {
    for (std::size_t j = i + 1; j < both.triangles.size(); ++j) {
      pairs += intersect_beyond_shared(both.view(), i, j);
    }
  }
  EXPECT_GT(pairs, 50u);
  EXPECT_EQ(v.self_intersections, pairs);
}

TEST(BoxPairs, FindsThePairsThatAllAgainstAllFinds) {
  for (const std::size_t size : {0u, 1u, 2u, 5u, 9u, 300u}) {
    constexpr std::uint64_t kSeed = 21;
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", boxes " + std::to_string(size));
    Random random(kSeed);
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < size; ++i) {
      // On a grid, so that many only touch; every third is a point or a repetition.
      const Point lower = grid_point(random, 12);
      const Point side = grid_point(random, 4);
      boxes.push_back({lower, i % 3 == 0 ? lower : Point(lower + side)});
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found, expected;
    BoxPairs(boxes).for_each(
        [&](std::uint32_t i, std::uint32_t j) { found.emplace_back(std::minmax(i, j)); });
    for (std::uint32_t i = 0; i < size; ++i) {
      for (std::uint32_t j = i + 1; j < size; ++j) {
        const bool disjoint = (boxes[i].lower.array() > boxes[j].upper.array()).any() ||
                              (boxes[j].lower.array() > boxes[i].upper.array()).any();
        if (!disjoint) expected.emplace_back(i, j);
      }
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(size < 300 || expected.size() > 300);
  }
}

}  // namespace
}  // namespace emax::test
