#include "host/tiles/tiled_decimation.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/surface/manifold_part.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/decimation.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

LocalTiles local;

bool within(MeshView mesh, MeshView of, double epsilon) {
  SurfaceDistanceOptions options;
  options.relative = 0;
  options.limit = epsilon;
  return surface_distance(mesh, ExactMesh(of), options).within(epsilon);
}

std::vector<TriangleMesh> surfaces() {
  const TriangleMesh open = manifold_part(without_vertex(bumpy(24, 40), 444)).mesh;
  return {bumpy(24, 40), sheet(24, 0.3), open, cube(6), joined(bumpy(20, 30), cube(4), {4, 0, 0})};
}

// With code that shares nothing with the decimator.
TEST(TiledDecimator, KeepsAllBoundsAndTheTopology) {
  for (const TriangleMesh& mesh : surfaces()) {
    const MeshTopology before = topology_of(mesh.view());
    const PointsInMemory points(mesh.vertices);
    for (const double epsilon : {0.005, 0.03}) {
      for (const std::size_t tile : {150u, 700u}) {
        const TiledDecimator decimator(mesh, points, tile, local);
        const DecimatedMesh result = decimator.run(with(epsilon));
        EXPECT_TRUE(certify(mesh.vertices, result.mesh.view()).within(epsilon));
        EXPECT_TRUE(within(result.mesh.view(), mesh.view(), epsilon));
        EXPECT_TRUE(within(mesh.view(), result.mesh.view(), epsilon));
        EXPECT_TRUE(check_mesh(result.mesh.view()).valid());
        EXPECT_EQ(topology_of(result.mesh.view()), before);
        EXPECT_TRUE(result.left_out.empty());
        EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size());
      }
    }
  }
}

TEST(TiledDecimator, KeepsPointsBetweenAndBesideTheVerticesNear) {
  const TriangleMesh mesh = sheet(30, 0.3);
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> weight(0, 1), away(-0.01, 0.01);
  std::vector<Point> cloud;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    const double u = weight(generator), v = weight(generator) * (1 - u);
    cloud.push_back(a + u * (b - a) + v * (c - a) + Point(0, 0, away(generator)));
  }
  cloud.push_back({0.5, 0.5, 5});  // too far
  DecimationSettings settings = with(0.03);
  settings.two_sided = false;
  const DecimatedMesh result =
      TiledDecimator(mesh, PointsInMemory(cloud), 400, local).run(settings);
  EXPECT_EQ(result.left_out,
            std::vector<std::uint32_t>{static_cast<std::uint32_t>(cloud.size() - 1)});
  EXPECT_TRUE(certify(cloud, result.mesh.view(), result.left_out).within(0.03));
  EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size() / 3);
}

TEST(TiledDecimator, GivesTheSameBytesForAnyNumberOfThreads) {
  const TriangleMesh mesh = bumpy(40, 60);
  DecimationSettings settings = with(0.01);
  const PointsInMemory points(mesh.vertices);
  const TiledDecimator decimator(mesh, points, 600, local);
  const DecimatedMesh one = decimator.run(settings);
  for (const std::size_t threads : {2u, 5u}) {
    settings.threads = threads;
    EXPECT_TRUE(same_bytes(decimator.run(settings).mesh, one.mesh));
  }
}

TEST(TiledDecimator, IsTheDecimatorWhereOneTileHoldsAll) {
  const TriangleMesh mesh = bumpy(24, 40);
  const DecimationSettings settings = with(0.02);
  const DecimatedMesh whole = BoundedDecimator(mesh, mesh.vertices).run(settings);
  const DecimatedMesh tiled =
      TiledDecimator(mesh, PointsInMemory(mesh.vertices), 1u << 20, local).run(settings);
  EXPECT_EQ(tiled.mesh.triangles.size(), whole.mesh.triangles.size());
}

TEST(TiledDecimator, GivesAMeshWithinAllBoundsBeforeTheSeamsAreDecimated) {
  const TriangleMesh mesh = bumpy(40, 60);
  const Point far(9, 9, 9);
  std::vector<Point> cloud = mesh.vertices;
  cloud.push_back(far);
  std::vector<DecimatedMesh> early;
  DecimationSettings settings = with(0.02);
  settings.early = [&early](DecimatedMesh made) { early.push_back(std::move(made)); };
  const DecimatedMesh result =
      TiledDecimator(mesh, PointsInMemory(cloud), 600, local).run(settings);
  ASSERT_EQ(early.size(), 1u);
  const TriangleMesh& made = early[0].mesh;
  EXPECT_LT(result.mesh.triangles.size(), made.triangles.size());
  EXPECT_LT(made.triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(check_mesh(made.view()).valid());
  EXPECT_TRUE(within(made.view(), mesh.view(), 0.02));
  EXPECT_TRUE(within(mesh.view(), made.view(), 0.02));
  EXPECT_EQ(early[0].left_out,
            std::vector<std::uint32_t>{static_cast<std::uint32_t>(mesh.vertices.size())});
  EXPECT_EQ(result.left_out, early[0].left_out);
}

TEST(TiledDecimator, AnInterruptLeavesAMeshWithinAllBounds) {
  const TriangleMesh mesh = bumpy(40, 60);
  for (const int polls : {0, 20, 200}) {
    std::atomic<int> left = polls;
    DecimationSettings settings = with(0.02);
    settings.interrupted = [&left] { return --left < 0; };
    const DecimatedMesh result =
        TiledDecimator(mesh, PointsInMemory(mesh.vertices), 600, local).run(settings);
    EXPECT_TRUE(result.interrupted);
    EXPECT_TRUE(check_mesh(result.mesh.view()).valid());
    EXPECT_TRUE(within(result.mesh.view(), mesh.view(), 0.02));
    EXPECT_TRUE(within(mesh.view(), result.mesh.view(), 0.02));
  }
}

TEST(TiledDecimator, TellsAShareThatGrows) {
  const TriangleMesh mesh = bumpy(40, 60);
  DecimationSettings settings = with(0.02);
  double last = 0;
  settings.advanced = [&last](double share, std::size_t triangles) {
    EXPECT_GE(share, last - 1e-9);
    EXPECT_LE(share, 1 + 1e-9);
    EXPECT_GT(triangles, 0u);
    last = share;
  };
  TiledDecimator(mesh, PointsInMemory(mesh.vertices), 600, local).run(settings);
  EXPECT_GT(last, 0.5);
}

}  // namespace
}  // namespace emax::test
