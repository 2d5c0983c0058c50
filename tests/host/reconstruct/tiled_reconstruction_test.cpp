#include "host/tiles/tiled_reconstruction.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/parameters/registry.h"
#include "host/reconstruct/part_surface.h"
#include "host/reconstruct/reconstruction.h"
#include "sw_model/base/error.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/corner_positions.h"
#include "tests/host/support/scanned_shapes.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

// In pieces of a few points, from the last to the first.
CloudSource source_of(const std::vector<Point>& points) {
  return {normalization_of(points), [&points](const CloudSource::Take& take) {
            constexpr std::size_t kPiece = 1000;
            for (std::size_t end = points.size(); end > 0;) {
              const std::size_t first = end - std::min(kPiece, end);
              take(std::span(points).subspan(first, end - first), first);
              end = first;
            }
          }};
}

RunParts here(const CloudPartition& cloud) {
  return [&cloud](PartStep step, std::span<const std::size_t> parts,
                  const std::function<void()>& done) {
    for (const std::size_t part : parts) {
      run_part_step(cloud.folder(), step, part);
      done();
    }
  };
}

ParameterValues standard(double least_reach = 0) {
  ParameterValues values(Imls::parameters());
  values.set(Imls::kLeastReach, least_reach);
  return values;
}

TiledReconstruction in_tiles(const std::vector<Point>& points, std::uint64_t most_points,
                             const ParameterValues& values = standard(), double thin = 0) {
  const TemporaryFolder folder;
  const CloudPartition cloud(source_of(points), most_points, folder.path());
  return reconstruct_in_tiles(cloud, values, estimate_scan(cloud, thin), {.thin = thin},
                              here(cloud));
}

// Smooth noise spares the ties between distances that a grid would have.
TEST(TiledReconstruction, IsTheSurfaceOfTheWholeCloudToTheLastBit) {
  for (const std::string_view shape : {"sphere", "torus", "sheet", "slots"}) {
    const ScanOfShape scan = scan_of_shape({.shape = shape, .noise = 0.1, .holes = true});
    const TriangleMesh whole = reconstruct(Imls::kName, scan.points, standard(1)).mesh;
    for (const std::uint64_t most : {100000u, 2000u, 700u}) {
      const TiledReconstruction tiled = in_tiles(scan.points, most, standard(1));
      EXPECT_EQ(corner_positions(tiled.mesh), corner_positions(whole)) << scan.name << ' ' << most;
      EXPECT_EQ(tiled.mesh.vertices.size(), whole.vertices.size()) << scan.name << ' ' << most;
      EXPECT_EQ(tiled.points, scan.points.size());
    }
  }
}

// Which point of a cube is taken does not depend on the parts.
TEST(TiledReconstruction, ThinsDenseRegionsAlike) {
  const ScanOfShape scan =
      scan_of_shape({.shape = "torus", .density = Density::kGraded, .noise = 0.1});
  const Normalization normalization = normalization_of(scan.points);
  const double side = normalization.length(1.5);
  std::vector<NumberedPoint> numbered;
  for (std::size_t i = 0; i < scan.points.size(); ++i) numbered.push_back({scan.points[i], i});
  std::vector<Point> expected;
  for (const NumberedPoint& p : thinned(numbered, normalization, side)) {
    expected.push_back(p.position);
  }
  EXPECT_LT(expected.size(), scan.points.size() / 2);
  const TiledReconstruction one = in_tiles(scan.points, 100000, standard(), side);
  EXPECT_EQ(one.points, expected.size());
  EXPECT_EQ(topology_of(one.mesh.view()), topology_of(scan.surface.view()));
  for (const std::uint64_t most : {2000u, 700u}) {
    const TiledReconstruction tiled = in_tiles(scan.points, most, standard(), side);
    EXPECT_EQ(tiled.points, expected.size());
    EXPECT_EQ(corner_positions(tiled.mesh), corner_positions(one.mesh));
  }
}

TEST(TiledReconstruction, SimplifiesEachPartWithoutASeam) {
  const ScanOfShape scan = scan_of_shape({.shape = "torus", .noise = 0.1, .holes = true});
  const TemporaryFolder folder;
  const CloudPartition cloud(source_of(scan.points), 2000, folder.path());
  const TriangleMesh fine = in_tiles(scan.points, 2000, standard(1)).mesh;
  const double deviation = cloud.normalization().length(0.2);
  const TriangleMesh coarse = reconstruct_in_tiles(cloud, standard(1), estimate_scan(cloud),
                                                   {.simplify = deviation}, here(cloud))
                                  .mesh;
  EXPECT_LT(coarse.triangles.size(), fine.triangles.size() / 3);
  EXPECT_TRUE(check_mesh(coarse.view()).valid());
  EXPECT_EQ(topology_of(coarse.view()), topology_of(fine.view()));
  const ExactMesh exact(fine.view());
  EXPECT_LT(surface_distance(coarse.view(), exact).upper, 1.0);
  EXPECT_LT(surface_distance(fine.view(), ExactMesh(coarse.view())).upper, 1.0);
}

TEST(TiledReconstruction, HasNoSeamWhereDistancesAreEqual) {
  std::vector<Point> grid;
  for (int x = 0; x < 60; ++x) {
    for (int y = 0; y < 60; ++y) grid.emplace_back(x, y, 0.02 * x * y);
  }
  const TiledReconstruction tiled = in_tiles(grid, 400);
  EXPECT_TRUE(check_mesh(tiled.mesh.view()).valid());
  const MeshTopology topology = topology_of(tiled.mesh.view());
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.border_loops, 1u);
}

TEST(TiledReconstruction, LeavesPartsOutThatHaveTooFewPoints) {
  std::vector<Point> points = scan_of_shape({.shape = "sphere"}).points;
  const std::size_t of_sphere = points.size();
  for (int i = 0; i < 3; ++i) points.emplace_back(1e5, 1e5, 1e5 + 1e4 * i);
  const TiledReconstruction tiled = in_tiles(points, 2000);
  EXPECT_GT(tiled.mesh.triangles.size(), of_sphere);
  EXPECT_TRUE(check_mesh(tiled.mesh.view()).valid());
}

TEST(TiledReconstruction, NeedsThreePointsSomewhere) {
  const std::vector<Point> same(1000, Point(1, 2, 3));
  const std::string message = message_of([&] { in_tiles(same, 100); });
  EXPECT_NE(message.find("three distinct points"), std::string::npos) << message;
}

TEST(TiledReconstruction, GoesOnWithTheStepsThatAreDone) {
  const std::vector<Point> points = scan_of_shape({.shape = "torus", .noise = 0.1}).points;
  const TemporaryFolder folder;
  const CloudPartition cloud(source_of(points), 1500, folder.path());
  std::size_t left = 9, steps = 0;
  const RunParts broken = [&](PartStep step, std::span<const std::size_t> parts,
                              const std::function<void()>& done) {
    for (const std::size_t part : parts) {
      if (left-- == 0) throw Interrupted{};
      run_part_step(folder.path(), step, part);
      done();
    }
  };
  const ScanEstimate estimate = estimate_scan(cloud);
  EXPECT_THROW(reconstruct_in_tiles(cloud, standard(), estimate, {}, broken), Interrupted);
  const RunParts rest = [&](PartStep step, std::span<const std::size_t> parts,
                            const std::function<void()>& done) {
    steps += parts.size();
    here(cloud)(step, parts, done);
  };
  const CloudPartition again(folder.path());
  const TiledReconstruction tiled = reconstruct_in_tiles(again, standard(), estimate, {}, rest);
  EXPECT_EQ(steps, 3 * cloud.parts().size() - 9);
  EXPECT_EQ(corner_positions(tiled.mesh), corner_positions(in_tiles(points, 1500).mesh));
}

}  // namespace
}  // namespace emax::test
