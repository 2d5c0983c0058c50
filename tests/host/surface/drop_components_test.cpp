#include "host/surface/drop_components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sw_model/certify/exact_distance.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

constexpr double kFar = 0.5;

void add_triangle(TriangleMesh& mesh, const Point& at, double size) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Point& corner : {Point(0, 0, 0), Point(size, 0, 0), Point(0, size, 0)}) {
    mesh.vertices.push_back(at + corner);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
}

// A square of two triangles, the largest component, and small triangles around it.
TriangleMesh square_with_pieces(Random& random, int pieces) {
  TriangleMesh mesh;
  mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (int i = 0; i < pieces; ++i) {
    const double x = random.uniform(-2.5, 2.5), y = random.uniform(-2.5, 2.5);
    add_triangle(mesh, {x, y, random.uniform(-1, 1)}, 0.2);
  }
  return mesh;
}

double distance(const Point& p, const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return point_triangle_distance(p, {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]})
      .upper;
}

double distance(const Point& p, const TriangleMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    least = std::min(least, distance(p, mesh, t));
  }
  return least;
}

// The pieces, each a triangle, that a point needs: by every distance.
std::size_t needed_pieces(const TriangleMesh& mesh, const std::vector<Point>& cloud) {
  std::vector<bool> needed(mesh.triangles.size(), false);
  for (const Point& p : cloud) {
    std::uint32_t nearest = 0;
    for (std::uint32_t t = 1; t < mesh.triangles.size(); ++t) {
      if (distance(p, mesh, t) < distance(p, mesh, nearest)) nearest = t;
    }
    const double to_square = std::min(distance(p, mesh, 0), distance(p, mesh, 1));
    if (nearest > 1 && to_square > kFar) needed[nearest] = true;
  }
  return static_cast<std::size_t>(std::ranges::count(needed, true));
}

TEST(DropNeedlessComponents, KeepsWhatAPointNeedsAndNoMore) {
  Random random(17);
  for (int round = 0; round < 30; ++round) {
    const TriangleMesh mesh = square_with_pieces(random, 20);
    std::vector<Point> cloud;
    for (int i = 0; i < 60; ++i) {
      cloud.emplace_back(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-1.5, 1.5));
    }
    const TriangleMesh rest = drop_needless_components(mesh, cloud, kFar);
    EXPECT_EQ(rest.triangles.size(), 2 + needed_pieces(mesh, cloud));
    EXPECT_LT(rest.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(rest.vertices.size(), 4 + 3 * (rest.triangles.size() - 2));
    for (const Point& p : cloud) {
      const double before = distance(p, mesh), after = distance(p, rest);
      EXPECT_TRUE(after <= kFar || after == before) << before << " " << after;
    }
  }
}

TEST(DropNeedlessComponents, LeavesOneComponentAlone) {
  Random random(3);
  const TriangleMesh square = square_with_pieces(random, 0);
  const std::vector<Point> far = {{0, 0, 9}};
  const TriangleMesh rest = drop_needless_components(square, far, kFar);
  EXPECT_EQ(rest.triangles, square.triangles);
  EXPECT_EQ(rest.vertices, square.vertices);
}

// Each that stays is needed beside those that are much larger, of many sizes.
TEST(DropNeedlessComponents, LargerOnesSpareSmallerOnes) {
  Random random(29);
  std::size_t spared = 0;
  for (int round = 0; round < 20; ++round) {
    TriangleMesh mesh = square_with_pieces(random, 0);
    for (int i = 0; i < 40; ++i) {
      const double x = random.uniform(-4, 4), y = random.uniform(-4, 4);
      add_triangle(mesh, {x, y, random.uniform(0.6, 1.5)}, std::exp(random.uniform(-4, 0)));
    }
    const TriangleMesh rest = drop_needless_components(mesh, mesh.vertices, kFar);
    for (const Point& p : mesh.vertices) EXPECT_LE(distance(p, rest), kFar);
    const auto area = [&](std::uint32_t t) {
      const auto [a, b, c] = rest.triangles[t];
      const double side = (rest.vertices[b] - rest.vertices[a]).norm();
      return t < 2 ? 16 : 0.5 * side * (rest.vertices[c] - rest.vertices[a]).norm();
    };
    for (std::uint32_t t = 2; t < rest.triangles.size(); ++t) {
      double farthest = 0;
      for (const std::uint32_t v : rest.triangles[t]) {
        double to_larger = std::numeric_limits<double>::infinity();
        for (std::uint32_t other = 0; other < rest.triangles.size(); ++other) {
          if (area(other) <= 8 * area(t)) continue;
          to_larger = std::min(to_larger, distance(rest.vertices[v], rest, other));
        }
        farthest = std::max(farthest, to_larger);
      }
      EXPECT_GT(farthest, kFar);
    }
    spared += needed_pieces(mesh, mesh.vertices) + 2 - rest.triangles.size();
  }
  EXPECT_GT(spared, 100u);
}

// By area, not by triangles: the pieces of a fan are more, but smaller.
TEST(DropNeedlessComponents, TheLargestIsTheOneOfTheGreatestArea) {
  TriangleMesh mesh;
  add_triangle(mesh, {0, 0, 0}, 4);
  mesh.vertices.insert(mesh.vertices.end(), {{9, 0, 0}, {9, 1, 0}, {9, 1, 1}, {9, 0, 1}});
  mesh.triangles.insert(mesh.triangles.end(), {{3, 4, 5}, {3, 5, 6}});
  EXPECT_EQ(drop_needless_components(mesh, {}, kFar).triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

}  // namespace
}  // namespace emax::test
