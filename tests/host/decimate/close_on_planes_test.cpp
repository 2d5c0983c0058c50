#include "host/decimate/close_on_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/surface/manifold_part.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/certify/matrix_free.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

constexpr std::uint32_t kSide = 41;  // vertices along a side of the plate, 0.05 apart
constexpr double kEpsilon = 0.06;

std::uint32_t on_plate(std::uint32_t i, std::uint32_t j) { return i * kSide + j; }

TriangleMesh without(TriangleMesh mesh, const std::set<std::uint32_t>& gone) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::ranges::any_of(t, [&](std::uint32_t v) { return gone.contains(v); });
  });
  return mesh;
}

// The vertices of a block with its first corner at (i, j).
std::set<std::uint32_t> block(std::uint32_t i, std::uint32_t j, std::uint32_t size) {
  std::set<std::uint32_t> vertices;
  for (std::uint32_t a = 0; a < size; ++a) {
    for (std::uint32_t b = 0; b < size; ++b) vertices.insert(on_plate(i + a, j + b));
  }
  return vertices;
}

// A plate with three small holes and a window of 0.3 x 0.3.
TriangleMesh plate_with_holes(double noise) {
  TriangleMesh plate = sheet(kSide, 0);
  Random random(named_seed("plate", 1));
  for (Point& v : plate.vertices) v += random.point(-noise, noise);
  std::set<std::uint32_t> gone = {on_plate(5, 5), on_plate(20, 8), on_plate(30, 33)};
  gone.merge(block(12, 20, 5));
  return without(plate, gone);
}

ClosedOnPlanes closed(const TriangleMesh& mesh, double farthest = kEpsilon,
                      std::size_t threads = 1) {
  return close_on_planes(mesh, find_plane_parts(mesh.vertices, kEpsilon, threads),
                         {kEpsilon, farthest, threads});
}

std::size_t borders(const TriangleMesh& mesh) { return topology_of(mesh.view()).border_loops; }

TEST(CloseOnPlanes, ClosesWhatEpsilonCannotTellAndLeavesTheWindowAndTheOutside) {
  for (const double noise : {0.0, 0.01}) {
    SCOPED_TRACE(noise);
    const TriangleMesh plate = plate_with_holes(noise);
    ASSERT_EQ(borders(plate), 5u);
    const ClosedOnPlanes made = closed(plate);
    EXPECT_EQ(made.on_planes, 3u);
    EXPECT_EQ(made.wide, 1u);
    EXPECT_EQ(borders(made.mesh), 2u);
    EXPECT_GT(made.area, 0);
    EXPECT_TRUE(check_mesh(made.mesh.view()).valid());
  }
}

TEST(CloseOnPlanes, ClosesTheWindowWhereItIsAskedTo) {
  const ClosedOnPlanes made = closed(plate_with_holes(0.01), 0.2);
  EXPECT_EQ(made.on_planes, 4u);
  EXPECT_EQ(borders(made.mesh), 1u);
  EXPECT_TRUE(check_mesh(made.mesh.view()).valid());
}

TEST(CloseOnPlanes, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh plate = plate_with_holes(0.01);
  const TriangleMesh one = closed(plate).mesh, three = closed(plate, kEpsilon, 3).mesh;
  EXPECT_EQ(one.vertices, three.vertices);
  EXPECT_EQ(one.triangles, three.triangles);
}

// The greatest distance of a point of the triangles at these vertices from all other triangles, by
// brute force over points of a grid.
double depth_of(const TriangleMesh& plate, const std::set<std::uint32_t>& gone, int grid) {
  const TriangleMesh left = without(plate, gone);
  const auto distance = [&](const Point& p) {
    double nearest = 100;
    for (std::size_t t = 0; t < left.triangles.size(); ++t) {
      const auto [a, b, c] = left.view().corners(t);
      nearest = std::min(nearest, eberly_squared_distance<double>(p, a, b, c));
    }
    return std::sqrt(nearest);
  };
  double depth = 0;
  for (std::size_t t = 0; t < plate.triangles.size(); ++t) {
    if (std::ranges::none_of(plate.triangles[t], [&](auto v) { return gone.contains(v); }))
      continue;
    const auto [a, b, c] = plate.view().corners(t);
    for (int i = 0; i <= grid; ++i) {
      for (int j = 0; i + j <= grid; ++j) {
        depth = std::max(depth, distance(a + (i * (b - a) + j * (c - a)) / grid));
      }
    }
  }
  return depth;
}

// Whether a hole of a flat plate is closed, beside the brute force, for holes of random sizes.
// Returns how many decisions differ.
int wrong_decisions() {
  constexpr int kGrid = 4;
  constexpr double kCell = 0.05 * 1.5 / kGrid;
  const TriangleMesh plate = sheet(kSide, 0);
  const PlaneParts parts = find_plane_parts(plate.vertices, kEpsilon, 1);
  Random random(named_seed("holes of a plate", 1));
  int wrong = 0, closed = 0, open = 0;
  for (int round = 0; round < 24; ++round) {
    std::set<std::uint32_t> gone;
    const auto at = [&](double from, double to) {
      return static_cast<std::uint32_t>(random.uniform(from, to));
    };
    for (int blocks = 0; blocks < 2; ++blocks) gone.merge(block(at(10, 13), at(10, 13), at(1, 6)));
    const double depth = depth_of(plate, gone, kGrid), farthest = random.uniform(0.04, 0.15);
    if (std::abs(depth - farthest) < kCell) continue;
    const ClosedOnPlanes made =
        close_on_planes(without(plate, gone), parts, {kEpsilon, farthest, 1});
    wrong += made.on_planes + made.own != (depth <= farthest ? 1u : 0u);
    ++(depth <= farthest ? closed : open);
  }
  EXPECT_GE(closed, 2);
  EXPECT_GE(open, 2);
  return wrong;
}

TEST(CloseOnPlanes, DecidesAsBruteForceDoes) { EXPECT_EQ(wrong_decisions(), 0); }

TEST(CloseOnPlanesFault, ThatClosesWideHolesIsSeen) {
  const DeliberateFault fault(Fault::kClosesWideHoles);
  EXPECT_GT(wrong_decisions(), 0);
}

bool within(const TriangleMesh& mesh, const TriangleMesh& of, double limit) {
  return decided_distance(mesh.view(), ExactMesh(of.view()), limit).within(limit);
}

// Rims that fold over themselves, so that triangles around them give way.
TEST(CloseOnPlanes, ChangesARoughSurfaceByNoMoreThanEpsilon) {
  std::size_t closed_holes = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    TriangleMesh plate = sheet(kSide, 0.02);
    Random random(named_seed("rough plate", seed));
    for (Point& v : plate.vertices) v += random.point(-0.022, 0.022);
    std::set<std::uint32_t> gone;
    for (int i = 0; i < 25; ++i) {
      gone.insert(on_plate(static_cast<std::uint32_t>(random.uniform(1, kSide - 1)),
                           static_cast<std::uint32_t>(random.uniform(1, kSide - 1))));
    }
    const TriangleMesh rough = manifold_part(without(plate, gone)).mesh;
    const ClosedOnPlanes made = closed(rough);
    EXPECT_TRUE(within(made.mesh, rough, kEpsilon));
    EXPECT_TRUE(within(rough, made.mesh, kEpsilon));
    EXPECT_TRUE(check_mesh(made.mesh.view()).valid());
    EXPECT_EQ(topology_of(made.mesh.view()).components, topology_of(rough.view()).components);
    closed_holes += made.on_planes + made.own;
    EXPECT_GE(borders(rough) - made.on_planes - made.own, borders(made.mesh));
  }
  EXPECT_GT(closed_holes, 30u);
}

// No plane holds the rim of a hole in an edge of the cube.
TEST(CloseOnPlanes, LeavesAHoleOverAnEdgeOpen) {
  TriangleMesh mesh = cube(16);
  std::uint32_t on_edge = 0, on_side = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if ((mesh.vertices[v] - Point(1, 1, 0)).norm() < 1e-9) on_edge = v;
    if ((mesh.vertices[v] - Point(1, 0, 0)).norm() < 1e-9) on_side = v;
  }
  mesh = without(mesh, {on_edge, on_side});
  const PlaneParts parts = find_plane_parts(mesh.vertices, kEpsilon, 1);
  const ClosedOnPlanes made = close_on_planes(mesh, parts, {kEpsilon, 1, 1});
  EXPECT_EQ(made.on_planes, 1u);
  EXPECT_EQ(made.own, 0u);
  EXPECT_EQ(borders(made.mesh), 1u);
}

// A piece of the plate within its hole is in the way.
TEST(CloseOnPlanes, LeavesAHoleWithAnIslandOpen) {
  TriangleMesh plate = plate_with_holes(0);
  TriangleMesh island = sheet(2, 0);
  for (Point& v : island.vertices) v = 0.05 * v + Point(-0.3, 0.1, 0);
  const TriangleMesh both = joined(plate, island, Point::Zero());
  const ClosedOnPlanes made = closed(both, 0.2);
  EXPECT_EQ(made.on_planes, 3u);
  EXPECT_EQ(borders(made.mesh), 3u);
  EXPECT_TRUE(check_mesh(made.mesh.view()).valid());
}

TEST(CloseOnPlanes, LeavesAClosedOrPlanelessMeshAsItIs) {
  const TriangleMesh box = cube(10);
  EXPECT_EQ(closed(box).mesh.triangles, box.triangles);
  const TriangleMesh plate = plate_with_holes(0);
  const ClosedOnPlanes made = close_on_planes(plate, PlaneParts{}, {1e-9, 1e-9, 1});
  EXPECT_EQ(made.mesh.triangles.size(), plate.triangles.size());
}

}  // namespace
}  // namespace emax::test
