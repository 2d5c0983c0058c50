#include "host/surface/crack_free.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/geometry/mesh_topology.h"
#include "host/surface/close_holes.h"
#include "tests/host/support/scanned_shapes.h"

namespace emax::test {
namespace {

// A grid of cells of side 1 over 60 x 40; the triangles whose middles `cut` tells are missing.
template <class Cut>
TriangleMesh grid_without(const Cut& cut) {
  TriangleMesh mesh = shape_surface("sheet", 0.5);
  for (Point& p : mesh.vertices) p.z() = 0;
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return cut(Point((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3));
  });
  return mesh;
}

bool in_crack(const Point& p) {  // wavers, 2 wide and 30 long
  return p.x() > 10 && p.x() < 40 && std::abs(p.y() - 20 - 3 * std::sin(p.x() / 5)) < 1;
}
bool in_hole(const Point& p) { return (p - Point(25, 20, 0)).norm() < 8; }

TEST(CrackFreeSurface, ClosesCracksAndLeavesHoles) {
  const TriangleMesh cracked = grid_without(in_crack), holed = grid_without(in_hole);
  ASSERT_EQ(topology_of(cracked.view()).border_loops, 2u);
  EXPECT_EQ(count_cracks(cracked, 3), 1u);
  EXPECT_EQ(count_cracks(holed, 3), 0u);

  const CrackFreeSurface closed = crack_free_surface(cracked, {}, 0, 0.9, 3, false);
  EXPECT_EQ(closed.closed_cracks, 1u);
  EXPECT_EQ(topology_of(closed.mesh.view()).border_loops, 1u);
  EXPECT_EQ(count_cracks(closed.mesh, 3), 0u);

  const CrackFreeSurface open = crack_free_surface(holed, {}, 0, 0.9, 3, false);
  EXPECT_EQ(open.closed_cracks, 0u);
  EXPECT_EQ(topology_of(open.mesh.view()).border_loops, 2u);
}

// Where the sheet turns by 90 degrees, and neither side of the slit faces the other.
TEST(CrackFreeSurface, ClosesASlitAlongASharpEdge) {
  constexpr double kEdge = 25;
  TriangleMesh slit = grid_without(
      [](const Point& p) { return std::abs(p.x() - kEdge) < 1 && p.y() > 10 && p.y() < 30; });
  for (Point& p : slit.vertices) {
    if (p.x() > kEdge) p = {kEdge, p.y(), kEdge - p.x()};
  }
  ASSERT_EQ(topology_of(slit.view()).border_loops, 2u);
  EXPECT_EQ(count_cracks(slit, 3), 1u);
  const CrackFreeSurface closed = crack_free_surface(slit, {}, 0, 0.9, 3, false);
  EXPECT_EQ(topology_of(closed.mesh.view()).border_loops, 1u);
}

// A tongue of the surface is as narrow, but what its border's sides have between them is there.
TEST(CrackFreeSurface, ATongueIsNoCrack) {
  const TriangleMesh tongue =
      grid_without([](const Point& p) { return p.x() > 20 && std::abs(p.y() - 20) > 1; });
  ASSERT_EQ(topology_of(tongue.view()).border_loops, 1u);
  EXPECT_EQ(count_cracks(tongue, 3), 0u);
}

// The fault that the width is there to catch: without it the hole is closed as well.
TEST(CrackFreeSurface, WouldCloseTheHoleWithoutAWidth) {
  EXPECT_EQ(close_holes(grid_without(in_hole), 0.9).closed, 1u);
}

TEST(CrackFreeSurface, NamesThePiecesThatNoPointNeeds) {
  TriangleMesh mesh = grid_without([](const Point&) { return false; });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{5, 5, 0.1}, {7, 5, 0.1}, {5, 6, 0.1}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  const std::vector<Point> cloud = {{5.5, 5.2, 0.05}, {20, 20, 0}};
  const CrackFreeSurface surface = crack_free_surface(mesh, cloud, 0.2, 0.9, 3, false);
  EXPECT_EQ(surface.dropped_pieces, 1u);
  EXPECT_NEAR(surface.dropped_area, 1, 1e-9);
  EXPECT_EQ(topology_of(surface.mesh.view()).components, 1u);
}

}  // namespace
}  // namespace emax::test
