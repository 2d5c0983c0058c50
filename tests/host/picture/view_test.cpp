#include "host/picture/view.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "host/geometry/triangle_mesh.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

// A square across the axis, seen from its positive end.
TriangleMesh square(Eigen::Index axis) {
  TriangleMesh mesh{{}, {{0, 1, 2}, {0, 2, 3}}};
  for (const auto& [u, v] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    Point p = Point::Zero();
    p[(axis + 1) % 3] = u;
    p[(axis + 2) % 3] = v;
    mesh.vertices.push_back(p);
  }
  return mesh;
}

// A cone of points whose base is across the axis.
std::vector<Point> cone(Eigen::Index axis) {
  std::vector<Point> points;
  for (int level = 0; level <= 40; ++level) {
    for (int i = 0; i < 60; ++i) {
      const double turn = 0.1047 * i, radius = 1 - level / 40.0;
      Point p;
      p[axis] = level / 20.0;
      p[(axis + 1) % 3] = radius * std::cos(turn);
      p[(axis + 2) % 3] = radius * std::sin(turn);
      points.push_back(p);
    }
  }
  return points;
}

TEST(View, UpIsWhereThingsStandAndZInDoubt) {
  EXPECT_EQ(up_of(cone(1)), Point::UnitY());
  EXPECT_EQ(up_of(cone(2)), Point::UnitZ());
  EXPECT_EQ(up_of(cone(0)), Point::UnitZ());
  EXPECT_EQ(up_of(bumpy_sphere(20, 20, 5000, 3).cloud), Point::UnitZ());
  const std::vector<Point> one = {{1, 2, 3}};
  EXPECT_EQ(up_of(one), Point::UnitZ());
}

TEST(View, LooksAtTheOuterSide) {
  for (const Eigen::Index axis : {0, 1, 2}) {
    const TriangleMesh mesh = square(axis);
    const View view = view_of(mesh.view(), mesh.vertices);
    EXPECT_GT(view.back[axis], 0.5) << axis;
    EXPECT_NEAR(view.back.norm(), 1, 1e-12);
    TriangleMesh turned = mesh;
    for (Triangle& t : turned.triangles) std::swap(t[0], t[1]);
    if (axis == 2) continue;  // from below nothing is looked at
    EXPECT_LT(view_of(turned.view(), turned.vertices).back[axis], -0.5) << axis;
  }
}

TEST(Camera, FitsWhatItLooksAt) {
  const Stimulus s = bumpy_sphere(12, 16, 0, 4);
  View view;
  view.back = Point(0.6, -0.7, 0.2).normalized();
  Camera camera(view, s.vertices);
  camera.fit(s.vertices, 10, 20, 300, 200);
  double left = 1e9, right = 0, top = 1e9, bottom = 0;
  for (const Point& p : s.vertices) {
    const auto seen = camera.see(p);
    ASSERT_TRUE(seen);
    left = std::min(left, seen->x);
    right = std::max(right, seen->x);
    top = std::min(top, seen->y);
    bottom = std::max(bottom, seen->y);
  }
  EXPECT_GE(left, 10 - 1e-9);
  EXPECT_LE(right, 310 + 1e-9);
  EXPECT_NEAR(top, 20, 1e-9);
  EXPECT_NEAR(bottom, 220, 1e-9);
  EXPECT_FALSE(camera.see(camera.eye() + view.back));
  EXPECT_GT(camera.nearer(1, 0.1), 1);
}

}  // namespace
}  // namespace emax::test
