#include "host/geometry/polygon_triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/files/mesh_file.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

std::vector<Triangle> fan_of(std::uint32_t corners) {
  std::vector<Triangle> fan;
  for (std::uint32_t i = 2; i < corners; ++i) fan.push_back({0, i - 1, i});
  return fan;
}

// Twice the signed area along z.
double area_of(const Triangle& t, const std::vector<Point>& p) {
  return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).z();
}

// Triangles between the corners that all face one way and have the polygon's area cover it once.
void expect_triangulation(const std::vector<Point>& polygon) {
  std::vector<Triangle> triangles = fan_of(static_cast<std::uint32_t>(polygon.size()));
  double area = 0;
  for (const Triangle& t : triangles) area += area_of(t, polygon);
  triangulate(triangles, polygon);
  double found = 0;
  for (const Triangle& t : triangles) {
    EXPECT_GT(area_of(t, polygon) / area, 0);
    found += area_of(t, polygon);
  }
  EXPECT_NEAR(found, area, 1e-12 * std::abs(area));
}

TEST(PolygonTriangulation, CoversPolygonsThatAreNotConvexOnce) {
  expect_triangulation({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  expect_triangulation({{1, 1, 0}, {0, 3, 0}, {-2, -2, 0}, {3, 0, 0}});
  // A side that a corner lies on.
  expect_triangulation({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  constexpr std::uint64_t kSeed = 31;
  Random random(kSeed);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", polygon " << i);
    const std::uint32_t corners = 4 + random.below(30);
    const double turn = i % 2 == 0 ? 1 : -1;
    std::vector<Point> polygon;
    for (std::uint32_t c = 0; c < corners; ++c) {
      const double angle = turn * 2 * std::numbers::pi * c / corners;
      const double radius = random.uniform(0.2, 2);
      polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    expect_triangulation(polygon);
  }
}

TEST(PolygonTriangulation, LeavesTheFanOfAConvexPolygon) {
  const std::vector<Point> square = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::vector<Triangle> triangles = fan_of(4);
  triangulate(triangles, square);
  EXPECT_EQ(triangles, fan_of(4));
}

TEST(PolygonTriangulation, LeavesTheFanWhereThereIsNoTriangulation) {
  const std::vector<Point> crossing = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  std::vector<Triangle> triangles = fan_of(4);
  triangulate(triangles, crossing);
  EXPECT_EQ(triangles, fan_of(4));
}

TEST(PolygonTriangulation, IsUsedWhereMeshesAreRead) {
  const TemporaryFolder folder;
  const TriangleMesh mesh =
      read_mesh(folder.write("arrow.off", "OFF\n4 1 0\n1 1 0\n0 3 0\n-2 -2 0\n3 0 0\n4 0 1 2 3\n"));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    EXPECT_GT(area_of(t, mesh.vertices), 0);
    area += area_of(t, mesh.vertices);
  }
  EXPECT_EQ(area, 18);
}

}  // namespace
}  // namespace emax::test
