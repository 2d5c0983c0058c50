#include "host/chain/fill_holes_smoothly.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/geometry/mesh_validity.h"
#include "host/vtk_stages/vtk_stages.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

// A sphere of radius 1 without its cap above z.
TriangleMesh sphere_without_cap(double z) {
  constexpr int kRings = 40, kSegments = 60;
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, -1});
  for (int i = 1; i < kRings; ++i) {
    const double polar = std::numbers::pi * (1 - static_cast<double>(i) / kRings);
    if (std::cos(polar) > z) break;
    for (int j = 0; j < kSegments; ++j) {
      const double turn = 2 * std::numbers::pi * (j + 0.5 * (i % 2)) / kSegments;
      mesh.vertices.push_back(
          {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)});
    }
  }
  const auto at = [](int ring, int segment) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * kSegments + segment % kSegments);
  };
  const int rings = static_cast<int>(mesh.vertices.size()) / kSegments;
  for (int j = 0; j < kSegments; ++j) mesh.triangles.push_back({0, at(1, j + 1), at(1, j)});
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < kSegments; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

double deepest(const TriangleMesh& mesh) {
  double least = 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    least = std::min(least, ((a + b + c) / 3).norm());
  }
  return least;
}

TEST(FillHolesSmoothly, FollowsTheCurvatureAround) {
  const TriangleMesh open = sphere_without_cap(0.85);
  const TriangleMesh flat = fill_holes(open, 1);
  ASSERT_EQ(check_mesh(flat.view()).boundary_edges, 0u);
  EXPECT_LT(deepest(flat), 0.9);  // the lid cuts the cap off
  const TriangleMesh smooth = fill_holes_smoothly(open, 1);
  EXPECT_TRUE(check_mesh(smooth.view()).valid());
  EXPECT_EQ(check_mesh(smooth.view()).boundary_edges, 0u);
  EXPECT_GT(deepest(smooth), 0.97);
  EXPECT_GT(smooth.vertices.size(), open.vertices.size() + 50);
  EXPECT_TRUE(std::ranges::all_of(smooth.vertices, [](const Point& p) { return p.norm() < 1.05; }));
  EXPECT_GT(signed_volume(smooth), signed_volume(flat));
  EXPECT_TRUE(same_bytes(fill_holes_smoothly(open, 1), smooth));
}

TEST(FillHolesSmoothly, LeavesTheMeshAndLargerHolesAsTheyAre) {
  const TriangleMesh open = sphere_without_cap(0.85);
  EXPECT_EQ(fill_holes_smoothly(open, 0.01).triangles.size(), open.triangles.size());
  const TriangleMesh smooth = fill_holes_smoothly(open, 1);
  for (const Triangle& t : open.triangles) {
    const bool there = std::ranges::any_of(smooth.triangles, [&](const Triangle& s) {
      return std::ranges::all_of(t, [&](std::uint32_t v) {
        return std::ranges::any_of(
            s, [&](std::uint32_t w) { return open.vertices[v] == smooth.vertices[w]; });
      });
    });
    ASSERT_TRUE(there);
  }
}

// Three sheets on one edge and two holes that touch in a vertex.
TEST(FillHolesSmoothly, SurvivesNonManifoldBoundaries) {
  const Stimulus sphere = bumpy_sphere(24, 36, 0, 31);
  TriangleMesh mesh{sphere.vertices, sphere.triangles};
  std::erase_if(mesh.triangles, [](const Triangle& t) {
    return std::ranges::count(t, 200u) + std::ranges::count(t, 202u) > 0;
  });
  mesh.vertices.push_back({0, 0, 3});
  const Triangle t = mesh.triangles[50];
  mesh.triangles.push_back({t[0], t[1], static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  const TriangleMesh filled = fill_holes_smoothly(mesh, 0.2);
  EXPECT_GE(filled.triangles.size(), mesh.triangles.size());
  EXPECT_LE(check_mesh(filled.view()).boundary_edges, check_mesh(mesh.view()).boundary_edges);
}

}  // namespace
}  // namespace emax::test
