#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/parameters/descriptions.h"
#include "host/reconstruct/reconstruction.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/host/features/clouds.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

constexpr double kNoise = 0.002;

TriangleMesh reconstruct(const std::vector<Point>& cloud, double reach = Shapes::kReach.standard,
                         std::size_t threads = 1) {
  ParameterValues values(method_named("shapes").parameters);
  values.set(Shapes::kReach, reach);
  return emax::reconstruct("shapes", cloud, values, threads).mesh;
}

std::vector<Point> scan_of(const std::vector<Patch>& patches, double density, Random& random) {
  std::vector<Point> cloud;
  for (const Patch& patch : patches) {
    const double area = patch.u.cross(patch.v).norm();
    scan_patch(patch, static_cast<std::size_t>(density * area), kNoise, random, cloud);
  }
  return cloud;
}

std::size_t faces_off(const TriangleMesh& mesh, double most,
                      const std::function<double(const Point&)>& distance_to_truth) {
  std::size_t off = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    if (distance_to_truth((a + b + c) / 3) > most) ++off;
  }
  return off;
}

TEST(Shapes, CloseARoomWhereItsWallsMeet) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const std::vector<Point> cloud = scan_of(sides_of_box({0, 0, 0}, {4, 3, 2}), 900, random);
    const TriangleMesh room = reconstruct(cloud);
    EXPECT_EQ(topology_of(room.view()), (MeshTopology{.components = 1}));
    EXPECT_TRUE(check_mesh(room.view()).valid());
    EXPECT_NEAR(std::abs(signed_volume(room)), 24, 0.02);
    EXPECT_EQ(reconstruct(cloud, Shapes::kReach.standard, 3).vertices, room.vertices);
  }
}

// Four walls, floor and ceiling of a room that turns around a corner.
std::vector<Patch> bent_room() {
  const Point x = Point::UnitX(), y = Point::UnitY(), z = 2 * Point::UnitZ();
  std::vector<Patch> patches;
  for (const double height : {0.0, 2.0}) {
    patches.push_back({{0, 0, height}, 4 * x, 2 * y});
    patches.push_back({{0, 2, height}, 2 * x, 2 * y});
  }
  const Point corners[] = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {2, 4, 0}, {0, 4, 0}};
  for (std::size_t i = 0; i < 6; ++i) {
    patches.push_back({corners[i], corners[(i + 1) % 6] - corners[i], z});
  }
  return patches;
}

TEST(Shapes, DoNotGoOnBehindACorner) {
  Random random(4);
  const TriangleMesh room = reconstruct(scan_of(bent_room(), 900, random));
  EXPECT_EQ(topology_of(room.view()), (MeshTopology{.components = 1}));
  EXPECT_NEAR(std::abs(signed_volume(room)), 24, 0.05);
}

TEST(ShapesFault, WhatGoesOnBehindACornerIsNoticed) {
  Random random(4);
  const std::vector<Point> cloud = scan_of(bent_room(), 900, random);
  const DeliberateFault fault(Fault::kSpansBeyondCurves);
  const TriangleMesh room = reconstruct(cloud);
  EXPECT_FALSE(topology_of(room.view()) == (MeshTopology{.components = 1}) &&
               std::abs(std::abs(signed_volume(room)) - 24) < 0.05);
}

TEST(Shapes, JoinAColumnToFloorAndCeiling) {
  Random random(5);
  std::vector<Point> cloud = scan_of(sides_of_box({0, 0, 0}, {4, 4, 2}), 900, random);
  const Cylinder column = {.centre = {1.5, 2, 1}, .axis = Point::UnitZ(), .radius = 0.4};
  const auto from_axis = [&](const Point& p) { return column.outward(p).norm(); };
  std::erase_if(cloud, [&](const Point& p) { return from_axis(p) < column.radius; });
  scan_cylinder(column, 2, 2 * std::numbers::pi, 4000, kNoise, random, cloud);
  const TriangleMesh room = reconstruct(cloud);
  EXPECT_EQ(topology_of(room.view()), (MeshTopology{.components = 1, .genus = 1}));
  EXPECT_NEAR(std::abs(signed_volume(room)), 32 - 2 * std::numbers::pi * 0.16, 0.05);
  EXPECT_EQ(faces_off(room, 6 * kNoise,
                      [&](const Point& p) {
                        const Point inward = (p - Point(2, 2, 1)).cwiseAbs() - Point(2, 2, 1);
                        return std::min(std::abs(inward.maxCoeff()), distance(column, p));
                      }),
            0u);
}

TEST(Shapes, LeaveAWindowOpen) {
  Random random(6);
  std::vector<Point> cloud = scan_of(sides_of_box({0, 0, 0}, {4, 3, 2}), 900, random);
  const auto in_window = [](const Point& p) {
    return p.y() < 0.1 && std::abs(p.x() - 2) < 0.6 && std::abs(p.z() - 1) < 0.6;
  };
  std::erase_if(cloud, in_window);
  const TriangleMesh room = reconstruct(cloud);
  EXPECT_EQ(topology_of(room.view()), (MeshTopology{.components = 1, .border_loops = 1}));
  EXPECT_EQ(topology_of(reconstruct(cloud, 20).view()), (MeshTopology{.components = 1}));
}

TEST(Shapes, LeaveTheRestToGreedyProjection) {
  Random random(7);
  std::vector<Point> cloud = scan_of({{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}}}, 300, random);
  const std::vector<Point> sphere = moved(sphere_cloud(2000), {0, 0, 2});
  cloud.insert(cloud.end(), sphere.begin(), sphere.end());
  const TriangleMesh both = reconstruct(cloud);
  EXPECT_EQ(topology_of(both.view()), (MeshTopology{.components = 2, .border_loops = 1}));
}

TEST(Shapes, OfACloudWithoutShapesAreGreedyProjection) {
  const std::vector<Point> sphere = sphere_cloud(1500);
  const ParameterValues values(method_named("gp3").parameters);
  EXPECT_EQ(topology_of(reconstruct(sphere).view()),
            topology_of(emax::reconstruct("gp3", sphere, values).mesh.view()));
}

TEST(Shapes, StandFarAway) {
  Random random(8);
  const std::vector<Point> cloud = scan_of(sides_of_box({0, 0, 0}, {4, 3, 2}), 900, random);
  const Point far(4e6, -3e6, 100);
  const TriangleMesh there = reconstruct(moved(cloud, far));
  EXPECT_EQ(topology_of(there.view()), (MeshTopology{.components = 1}));
  EXPECT_NEAR(std::abs(signed_volume(there)), 24, 0.02);
}

}  // namespace
}  // namespace emax::test
