#include "host/decimate/edge_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/host/support/decimation.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kPlaceLimit = 0.1;

enum class Surface { kSmooth, kRough, kFaceted, kGrooved };

TriangleMesh surface(Surface kind) {
  if (kind == Surface::kFaceted) return cube(2);
  if (kind == Surface::kGrooved) {
    // Over a groove the reference is farthest between its walls, where it has no edge.
    TriangleMesh mesh = sheet(41, 0);
    for (Point& p : mesh.vertices) {
      if (std::lround((p[0] + 1) * 20) % 8 < 4) p[2] -= 0.3;
    }
    return mesh;
  }
  TriangleMesh mesh = sheet(30, 0.2);
  Random random(11);
  if (kind == Surface::kSmooth) return mesh;
  for (Point& p : mesh.vertices) p += random.point(-0.02, 0.02);
  return mesh;
}

class EdgePlaces : public testing::TestWithParam<Surface> {
 protected:
  EdgePlaces() : mesh_(surface(GetParam())), back_(mesh_, kPlaceLimit) {}

  // An edge whose ends are near the surface.
  std::array<EdgeEnd, 2> draw() {
    const auto end = [&](const Point& p) { return EdgeEnd{p, back_.sight(p)}; };
    const auto near = [&] {
      const auto v = random_.below(static_cast<std::uint32_t>(mesh_.vertices.size()));
      return Point(mesh_.vertices[v] + random_.point(-0.04, 0.04));
    };
    const Point from = near();
    Point to = near();
    while ((to - from).norm() > 0.9) to = 0.5 * (from + near());
    return {end(from), end(to)};
  }

  TriangleMesh mesh_;
  BackBound back_;
  Random random_{7};
};

TEST_P(EdgePlaces, LeaveNothingFarther) {
  constexpr int kSteps = 64;
  std::size_t within = 0, inside = 0, near = 0;
  for (int i = 0; i < 120; ++i) {
    const auto [from, to] = draw();
    double found = std::max(from.sight.share, to.sight.share), farthest = 0;
    const double at_ends = found;
    const std::vector<EdgePlace> places = farthest_places(back_, from, to);
    for (const EdgePlace& p : places) found = std::max(found, p.sight.share);
    for (int k = 0; k <= kSteps; ++k) {
      const double t = static_cast<double>(k) / kSteps;
      farthest = std::max(farthest, share_of((1 - t) * from.at + t * to.at, mesh_, kPlaceLimit));
    }
    if (farthest > 1) continue;  // sights end at twice the limit
    ++within;
    inside += farthest > 1.1 * at_ends ? 1 : 0;
    // A parabola is taken as such where the quarters are off by less than a tenth of the limit.
    EXPECT_GE(std::sqrt(found), std::sqrt(farthest) / 1.05 - 0.2) << i;
    near += std::sqrt(found) >= std::sqrt(farthest) / 1.02 - 0.01 ? 1 : 0;
    EXPECT_LE(found, farthest * 1.1 + 1e-3) << i;
  }
  EXPECT_GT(within, 50u);
  EXPECT_GT(inside, 10u);
  EXPECT_GT(near, within * 8 / 10);
}

TEST_P(EdgePlaces, AreFewInsideTheEdgeAndInOrder) {
  std::size_t several = 0;
  for (int i = 0; i < 200; ++i) {
    const auto [from, to] = draw();
    const std::vector<EdgePlace> places = farthest_places(back_, from, to);
    ASSERT_GE(places.size(), 1u);
    ASSERT_LE(places.size(), 8u);
    EXPECT_TRUE(std::ranges::is_sorted(places, {}, &EdgePlace::along));
    for (const EdgePlace& p : places) {
      EXPECT_GT(p.along, 0);
      EXPECT_LT(p.along, 1);
      const Point at = (1 - p.along) * from.at + p.along * to.at;
      if (p.sight.triangle == kNoIndex) continue;
      EXPECT_DOUBLE_EQ(p.sight.share, back_.share_of(at, p.sight.triangle));
      EXPECT_NEAR(p.sight.share, share_of(at, mesh_, kPlaceLimit), 1e-9);
    }
    several += places.size() > 1 ? 1 : 0;
  }
  if (GetParam() == Surface::kRough) {
    EXPECT_GT(several, 50u);
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, EdgePlaces,
                         testing::Values(Surface::kSmooth, Surface::kRough, Surface::kFaceted,
                                         Surface::kGrooved));

// A ridge of the reference between two places far from it.
TEST(EdgePlacesOfARidge, AreOnTheRidge) {
  const TriangleMesh ridge = {
      {{0, 0, 0}, {1, 0, 0.3}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0.3}, {2, 1, 0}},
      {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}};
  const BackBound back(ridge, 1);
  const Point from(0.1, 0.5, 0.03), to(1.9, 0.5, 0.03);
  const std::vector<EdgePlace> places =
      farthest_places(back, {from, back.sight(from)}, {to, back.sight(to)});
  ASSERT_EQ(places.size(), 1u);
  EXPECT_NEAR(places[0].along, 0.5, 1e-12);
}

}  // namespace
}  // namespace emax::test
