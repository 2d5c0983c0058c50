// The sides of a mesh beside the winding number, which knows of no nearest triangle.
#include "host/geometry/mesh_sides.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/geometry/triangle_mesh.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

// How often the mesh goes round p: 1 inside, 0 outside (van Oosterom and Strackee, 1983).
double winding_number(MeshView mesh, const Point& p) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    auto v = mesh.corners(t);
    for (Point& corner : v) corner = (corner - p).normalized();
    const double volume = v[0].dot(v[1].cross(v[2]));
    sum += 2 * std::atan2(volume, 1 + v[0].dot(v[1]) + v[1].dot(v[2]) + v[2].dot(v[0]));
  }
  return sum / (4 * std::numbers::pi);
}

TriangleMesh turned(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// Its tips are so sharp that most points near a tip lie on the wrong side of one of its triangles.
TriangleMesh sharp_tetrahedron(Random& random) {
  TriangleMesh mesh{{}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  for (int i = 0; i < 4; ++i) mesh.vertices.push_back(random.point(-1, 1));
  const auto& v = mesh.vertices;
  if ((v[1] - v[0]).cross(v[2] - v[0]).dot(v[3] - v[0]) < 0) return turned(mesh);
  return mesh;
}

TriangleMesh bumpy(std::uint64_t seed) {
  const Stimulus s = bumpy_sphere(7, 9, 0, seed);
  return {s.vertices, s.triangles};
}

// Points of which the two disagree.
std::size_t disagreements(const TriangleMesh& mesh, Random& random, int points) {
  const MeshSides sides(mesh.view());
  const ExactMesh exact(mesh.view());
  std::size_t wrong = 0;
  for (int i = 0; i < points; ++i) {
    const Point p = random.point(-1.5, 1.5);
    const double winding = std::abs(winding_number(mesh.view(), p));
    const bool inside = sides.side_of(p, exact.nearest(p).triangle) < 0;
    if (inside != (winding > 0.5)) ++wrong;
  }
  return wrong;
}

TEST(MeshSides, AreThoseOfTheWindingNumber) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(named_seed("mesh sides", seed));
    const TriangleMesh sharp = sharp_tetrahedron(random), round = bumpy(seed);
    EXPECT_EQ(disagreements(sharp, random, 400), 0u) << "seed " << seed;
    EXPECT_EQ(disagreements(round, random, 400), 0u) << "seed " << seed;
    // A closed mesh that is inside out is turned.
    EXPECT_EQ(disagreements(turned(sharp), random, 100), 0u) << "seed " << seed;
  }
}

TEST(MeshSides, OfOneTriangleAreThoseOfItsNormal) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const MeshSides sides(mesh.view());
  for (const Point& p : {Point(0.2, 0.2, 0.1), Point(-3, 1, 0.1), Point(2, 2, 5)}) {
    EXPECT_EQ(sides.side_of(p, 0), 1);
    EXPECT_EQ(sides.side_of({p.x(), p.y(), -p.z()}, 0), -1);
  }
}

TEST(MeshSides, DegenerateTrianglesCountForNothing) {
  TriangleMesh mesh = bumpy(3);
  mesh.triangles.push_back({0, 0, 1});
  mesh.vertices.push_back(mesh.vertices[0]);
  Random random(named_seed("mesh sides", 99));
  EXPECT_EQ(disagreements(mesh, random, 300), 0u);
}

TEST(MeshSidesFault, TheNearestTrianglesNormalAloneIsCaught) {
  const DeliberateFault fault(Fault::kSideOfOneTriangle);
  Random random(named_seed("mesh sides", 1));
  EXPECT_GT(disagreements(sharp_tetrahedron(random), random, 400), 0u);
}

}  // namespace
}  // namespace emax::test
