#include "host/decimate/plane_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/decimate/plane_place.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

const Plane kFloor = {{0, 0, 1}, 1}, kWall = {{1, 0, 0}, 2}, kSide = {{0, 1, 0}, 3};

TEST(PlanePlace, OfOnePlaneIsAllOfIt) {
  const std::vector<Plane> planes = {kFloor};
  const auto place = place_on(planes, {5, 6, 7}, 0.1);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->at, Point(5, 6, 1));
  EXPECT_EQ(place->project({8, 9, 10}), Point(8, 9, 1));
}

TEST(PlanePlace, OfTwoPlanesIsTheirLineAndOfThreeTheirCorner) {
  const std::vector<Plane> planes = {kFloor, kWall, kSide};
  const auto line = place_on(std::span(planes).first(2), {5, 6, 7}, 0.1);
  ASSERT_TRUE(line);
  EXPECT_LT((line->project({8, 9, 10}) - Point(2, 9, 1)).norm(), 1e-12);
  const auto corner = place_on(planes, {5, 6, 7}, 0.1);
  ASSERT_TRUE(corner);
  EXPECT_LT((corner->project({8, 9, 10}) - Point(2, 3, 1)).norm(), 1e-12);
}

TEST(PlanePlace, IsNoneOfPlanesThatShareNoPoint) {
  const std::vector<Plane> parallel = {kFloor, {{0, 0, 1}, 1.5}};
  EXPECT_FALSE(place_on(parallel, {0, 0, 0}, 0.1));
  const Point tilted = Point(1, 1, 1).normalized();
  std::vector<Plane> four = {kFloor, kWall, kSide, {tilted, tilted.dot(Point(2, 3, 1))}};
  EXPECT_TRUE(place_on(four, {0, 0, 0}, 0.1));
  four.back().offset += 0.5;
  EXPECT_FALSE(place_on(four, {0, 0, 0}, 0.1));
}

// Otherwise the least tilt of a plane would throw the line far away.
TEST(PlanePlace, TakesPlanesThatHardlyDifferAsOne) {
  const Point tilted = Point(0.01, 0, 1).normalized();
  const std::vector<Plane> planes = {{{0, 0, 1}, 1}, {tilted, tilted.z() * 1.02}};
  const auto place = place_on(planes, {0.5, 6, 7}, 0.1);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->at.z(), 1.01, 0.005);
  EXPECT_NEAR(place->at.x(), 0.5, 0.05);
}

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

}  // namespace
}  // namespace emax::test
