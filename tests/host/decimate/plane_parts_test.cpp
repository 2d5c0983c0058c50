#include "host/decimate/plane_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

// A cube's sides, of which each point knows its own.
PlaneParts sides_of_a_cube() {
  PlaneParts parts;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      parts.planes.push_back({Point::Unit(axis), side});
      for (int i = -9; i <= 9; ++i) {
        for (int j = -9; j <= 9; ++j) {
          Point p;
          p[axis] = side;
          p[(axis + 1) % 3] = 0.1 * i;
          p[(axis + 2) % 3] = 0.1 * j;
          parts.points.push_back(p);
          parts.plane_of.push_back(static_cast<std::uint32_t>(parts.planes.size() - 1));
        }
      }
    }
  }
  return parts;
}

TEST(PlanesOfTriangles, FollowTheSidesOfACubeUpToItsEdges) {
  const TriangleMesh mesh = cube(10);
  const PlaneParts parts = sides_of_a_cube();
  const std::vector<std::uint32_t> planes = planes_of_triangles(mesh, parts, 0.05, 1);
  ASSERT_EQ(planes.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < planes.size(); ++t) {
    ASSERT_NE(planes[t], PlaneParts::kNoPlane);
    for (const std::uint32_t v : mesh.triangles[t]) {
      EXPECT_NEAR(parts.planes[planes[t]].signed_distance(mesh.vertices[v]), 0, 1e-12);
    }
  }
  EXPECT_EQ(planes_of_triangles(mesh, parts, 0.05, 3), planes);
}

TEST(PlanesOfTriangles, LeaveOutWhatIsFarFromThePlane) {
  TriangleMesh mesh = cube(10);
  mesh.vertices[0] *= 1.2;  // a corner
  const std::vector<std::uint32_t> planes = planes_of_triangles(mesh, sides_of_a_cube(), 0.05, 1);
  for (std::size_t t = 0; t < planes.size(); ++t) {
    const bool at_corner = std::ranges::find(mesh.triangles[t], 0u) != mesh.triangles[t].end();
    EXPECT_EQ(planes[t] == PlaneParts::kNoPlane, at_corner);
  }
}

TEST(PlanesOfTriangles, AreNoneWithoutPlanes) {
  PlaneParts parts = sides_of_a_cube();
  parts.plane_of.assign(parts.points.size(), PlaneParts::kNoPlane);
  for (const std::uint32_t plane : planes_of_triangles(cube(10), parts, 0.05, 1)) {
    EXPECT_EQ(plane, PlaneParts::kNoPlane);
  }
}

TEST(FindPlaneParts, FindsTheSidesOfACubeAndNoneInNoise) {
  const TriangleMesh mesh = cube(20);
  const PlaneParts parts = find_plane_parts(mesh.vertices, 0.02, 1);
  EXPECT_EQ(parts.planes.size(), 6u);
  EXPECT_EQ(parts.points.size(), mesh.vertices.size());
  EXPECT_TRUE(find_plane_parts(bumpy(30, 50).vertices, 0.001, 1).planes.empty());
}

TEST(FindPlaneParts, NumbersCurvedShapesAfterThePlanes) {
  const TriangleMesh mesh = can(80, 24);
  const PlaneParts parts = find_plane_parts(mesh.vertices, 0.02, 1, [] {}, {.curved = true});
  ASSERT_EQ(parts.planes.size(), 2u);
  ASSERT_EQ(parts.curved.size(), 1u);
  const auto* side = std::get_if<Cylinder>(&parts.curved.front());
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->radius, 1, 1e-6);
  const std::vector<Shape> shapes = parts.shapes();
  ASSERT_EQ(parts.support.size(), 3u);
  std::vector<std::size_t> counted(3);
  for (std::size_t p = 0; p < parts.points.size(); ++p) {
    const std::uint32_t number = parts.plane_of[p];
    if (number == PlaneParts::kNoPlane) continue;
    ++counted[number];
    EXPECT_LE(distance(shapes[number], parts.points[p]), 0.01 * (1 + 1e-9));
  }
  for (std::size_t s = 0; s < 3; ++s) EXPECT_EQ(counted[s], parts.support[s].points);
  EXPECT_TRUE(find_plane_parts(mesh.vertices, 0.02, 1).curved.empty());
}

// The corners of its rim alone do not tell the end of a cylinder from its side.
TEST(ShapesUnder, TellTheEndOfACylinderFromItsSide) {
  const Cylinder side{{0, 0, 0}, {0, 0, 1}, 1};
  const auto rim = [](double angle, double z) {
    return Point(std::cos(angle), std::sin(angle), z);
  };
  const double third = 2 * std::numbers::pi / 3;
  const TriangleMesh mesh = {{rim(0, 1), rim(third, 1), rim(2 * third, 1), rim(0.2, -1)},
                             {{0, 1, 2}, {0, 3, 2}}};
  constexpr std::uint32_t kNone = PlaneParts::kNoPlane;
  const std::vector<Shape> both = {Plane{{0, 0, 1}, 1}, side};
  using Numbers = std::vector<std::uint32_t>;
  EXPECT_EQ(shapes_under(mesh, both, 1e-9, 0.5), (Numbers{0, 1}));
  EXPECT_EQ(shapes_under(mesh, std::span(both).last(1), 1e-9, 0.5), (Numbers{kNone, 0}));
  EXPECT_EQ(shapes_under(mesh, std::span(both).last(1), 1e-9, 0.01), (Numbers{kNone, kNone}));
}

}  // namespace
}  // namespace emax::test
