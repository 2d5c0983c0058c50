#include "host/decimate/back_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

double farthest(const std::array<Point, 3>& corners, const ExactMesh& reference) {
  const std::vector<Triangle> one = {{0, 1, 2}};
  return surface_distance({corners, one}, reference).upper / 1.01;
}

const Point& any_vertex(const TriangleMesh& mesh, Random& random) {
  return mesh.vertices[random.below(static_cast<std::uint32_t>(mesh.vertices.size()))];
}

class BackBoundTwin : public testing::Test {
 protected:
  // Whether what is proven is so, and how much that is so is proven.
  void compare(const TriangleMesh& mesh, double limit,
               const std::vector<std::array<Point, 3>>& triangles) {
    const BackBound bound(mesh, limit);
    const ExactMesh reference(mesh.view());
    for (const std::array<Point, 3>& t : triangles) {
      const double exact = farthest(t, reference);
      const bool held = bound.holds(t, bound.sight(t[0]).triangle, *bound.make_search());
      EXPECT_TRUE(!held || exact <= limit * (1 + 1e-9)) << exact;
      within_ += exact < 0.95 * limit ? 1 : 0;
      proven_ += held ? 1 : 0;
      beyond_ += exact > limit ? 1 : 0;
    }
  }
  std::size_t within_ = 0, proven_ = 0, beyond_ = 0;
};

std::vector<TriangleMesh> references() {
  return {bumpy(30, 50), sheet(30, 0.3), without_vertex(sheet(20, 0.1), 190), cube(8),
          joined(sheet(20, 0.3), sheet(20, 0.3), {0, 0, 0.05})};
}

TEST_F(BackBoundTwin, TrianglesOfTheReferencesOwnVertices) {
  Random random(11);
  for (const TriangleMesh& mesh : references()) {
    std::vector<std::array<Point, 3>> triangles;
    for (int i = 0; i < 400; ++i) {
      const Point& a = any_vertex(mesh, random);
      std::vector<Point> near;
      const double reach = random.uniform(0.1, 0.8);
      for (const Point& p : mesh.vertices) {
        if (p != a && (p - a).norm() < reach) near.push_back(p);
      }
      if (near.size() < 2) continue;
      const Point& b = near[random.below(static_cast<std::uint32_t>(near.size()))];
      const Point& c = near[random.below(static_cast<std::uint32_t>(near.size()))];
      if ((b - a).cross(c - a).norm() > 1e-6) triangles.push_back({a, b, c});
    }
    for (const double limit : {0.005, 0.05}) compare(mesh, limit, triangles);
  }
  EXPECT_GT(beyond_, 100u);
  EXPECT_GT(within_, 500u);
  EXPECT_GT(proven_, within_ * 9 / 10);
}

TEST_F(BackBoundTwin, TrianglesNearTheReference) {
  Random random(12);
  for (const TriangleMesh& mesh : references()) {
    std::vector<std::array<Point, 3>> triangles;
    for (int i = 0; i < 400; ++i) {
      const Point& a = any_vertex(mesh, random);
      const double size = random.uniform(0.02, 0.4);
      triangles.push_back({a + 0.01 * random.point(-1, 1), a + size * random.point(-1, 1),
                           a + size * random.point(-1, 1)});
    }
    compare(mesh, 0.04, triangles);
    compare(mesh, 0.15, triangles);
  }
  EXPECT_GT(beyond_, 500u);
  EXPECT_GT(within_, 200u);
  EXPECT_GT(proven_, within_ * 8 / 10);
}

// Three turns of a ramp between two circles, all within the limit of the plane.
TriangleMesh ramp(const Point& centre, double inner, double outer) {
  constexpr std::uint32_t kSteps = 72;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    const double angle = i * std::numbers::pi / 12, height = 0.04 * i / kSteps - 0.02;
    for (const double radius : {inner, outer}) {
      mesh.vertices.push_back(centre +
                              Point(radius * std::cos(angle), radius * std::sin(angle), height));
    }
  }
  for (std::uint32_t v = 0; v < 2 * kSteps; v += 2) {
    mesh.triangles.push_back({v, v + 1, v + 3});
    mesh.triangles.push_back({v, v + 3, v + 2});
  }
  return mesh;
}

// What is covered three times makes up in area for what is not covered at all.
TEST_F(BackBoundTwin, ASheetThatCoversItselfDoesNotCoverTheRest) {
  const std::vector<std::array<Point, 3>> triangle = {
      {Point(0, 0, 0), Point(-0.78, -0.45, 0), Point(0.78, -0.45, 0)}};
  compare(ramp({0, -0.23, 0}, 0.03, 0.2), 0.05, triangle);
  EXPECT_EQ(beyond_, 1u);
}

// A triangle that hangs over an edge of the reference has nothing under the part that hangs over.
// With triangles of the reference much smaller than T this part takes many of them.
TEST(BackBound, ProvesATriangleThatHangsOverAnEdge) {
  constexpr double kLimit = 0.02;
  const BackBound bound(cube(40), kLimit);
  for (const double over : {0.0, 0.2, 0.6, 0.9, 1.1}) {
    const double x = 1 + over * kLimit;
    const std::array<Point, 3> t = {Point(-0.9, -0.8, 1), Point(x, -0.9, 1), Point(x, 0.9, 1)};
    EXPECT_EQ(bound.holds(t, bound.sight(t[0]).triangle, *bound.make_search()), over < 1) << over;
  }
}

// Of all edges of a reference that has one sheet under the segment, sorted.
std::vector<double> crossings_of_all_edges(const EditableMesh& mesh, const Point& from,
                                           const Point& to, const Point& up) {
  const Point along = to - from, normal = along.cross(up);
  std::vector<double> found;
  for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
    const std::array<Point, 3> c = mesh.corners(slot);
    for (std::size_t i = 0; i < 3; ++i) {
      const Triangle& t = mesh.triangle(slot);
      const double a = normal.dot(c[i] - from), b = normal.dot(c[(i + 1) % 3] - from);
      if (t[i] > t[(i + 1) % 3] || (a >= 0) == (b >= 0)) continue;
      const Point at = c[i] + a / (a - b) * (c[(i + 1) % 3] - c[i]);
      const double share = along.dot(at - from) / along.squaredNorm();
      if (share > 0 && share < 1) found.push_back(share);
    }
  }
  std::ranges::sort(found);
  return found;
}

TEST(BackBound, FollowsTheReferenceUnderASegment) {
  constexpr double kHeight = 0.1;
  const BackBound bound(sheet(20, kHeight), 0.5);
  Random random(5);
  std::size_t followed = 0;
  for (int i = 0; i < 300; ++i) {
    Point from = random.point(-1.2, 1.2), to = random.point(-1.2, 1.2);
    from[2] = random.uniform(-0.1, 0.1);
    to[2] = random.uniform(-0.1, 0.1);
    const Point middle = 0.5 * (from + to);
    const std::uint32_t near = bound.sight(middle).triangle;
    const auto inside = [](const Point& p) { return std::abs(p[0]) < 0.9 && std::abs(p[1]) < 0.9; };
    if (near == kNoIndex || !inside(middle)) continue;
    const Point up = bound.toward(middle, near);
    std::vector<BackBound::Crossing> crossings;
    if (!bound.follow(from, to, up, near, crossings)) {
      EXPECT_FALSE(inside(from) && inside(to)) << i;
      continue;
    }
    ++followed;
    const std::vector<double> all = crossings_of_all_edges(bound.reference(), from, to, up);
    ASSERT_EQ(crossings.size(), all.size()) << i;
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_NEAR(crossings[k].along, all[k], 1e-12);
    for (std::size_t k = 1; k < all.size(); ++k) {
      EXPECT_EQ(crossings[k].before, crossings[k - 1].behind);
    }
  }
  EXPECT_GT(followed, 50u);
}

TEST(BackBound, DoesNotFollowAReferenceThatTurnsBack) {
  const BackBound bound(cube(8), 0.5);
  const Point from(0.4, 0.1, 1), to(1.6, 0.13, 0.9), up(0, 0, 1);
  std::vector<BackBound::Crossing> crossings;
  EXPECT_FALSE(bound.follow(from, to, up, bound.sight({0.9, 0.11, 1}).triangle, crossings));
}

// By all pairs of triangles.
TEST(BackBound, KnowsHowHighNeighboursUsuallyRise) {
  for (const TriangleMesh& mesh : references()) {
    std::vector<double> rises;
    for (std::size_t s = 0; s < mesh.triangles.size(); ++s) {
      for (std::size_t t = s + 1; t < mesh.triangles.size(); ++t) {
        std::vector<std::uint32_t> others;
        for (const std::uint32_t v : mesh.triangles[t]) {
          if (std::ranges::find(mesh.triangles[s], v) == mesh.triangles[s].end()) {
            others.push_back(v);
          }
        }
        if (others.size() != 1) continue;
        const auto c = mesh.view().corners(s);
        const Point normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
        rises.push_back(std::abs(normal.dot(mesh.vertices[others[0]] - c[0])));
      }
    }
    std::ranges::sort(rises);
    // Which of two triangles is looked at from the other depends on their order.
    const auto at = [&](double share) {
      return rises[static_cast<std::size_t>(share * static_cast<double>(rises.size() - 1))];
    };
    const double found = BackBound(mesh, 1).usual_rise();
    EXPECT_GE(found, at(0.72) - 1e-12);
    EXPECT_LE(found, at(0.78) + 1e-12);
  }
}

// Far from everything, out of sight of the hint.
TEST(BackBound, RefusesWhatItDoesNotSee) {
  const BackBound bound(bumpy(10, 16), 0.05);
  const std::array<Point, 3> away = {Point(5, 0, 0), Point(6, 0, 0), Point(5, 1, 0)};
  EXPECT_EQ(bound.sight(away[0]).triangle, kNoIndex);
  EXPECT_FALSE(bound.holds(away, kNoIndex, *bound.make_search()));
  EXPECT_FALSE(bound.holds(away, 0, *bound.make_search()));
}

}  // namespace
}  // namespace emax::test
