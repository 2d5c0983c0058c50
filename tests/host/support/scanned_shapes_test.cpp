#include "tests/host/support/scanned_shapes.h"

#include <gtest/gtest.h>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/scan_estimate.h"
#include "sw_model/certify/exact_distance.h"

namespace emax::test {
namespace {

MeshTopology known(std::string_view shape, bool holes) {
  MeshTopology topology{1, 0, 0};
  if (shape == "torus") topology.genus = 1;
  if (shape == "sheet") topology.border_loops = 1;
  if (shape == "slots") topology.components = 2;
  // The sheet has its second hole at its border.
  if (holes) topology.border_loops += shape == "sheet" ? 1 : 2;
  return topology;
}

TEST(ScannedShapes, AreTheSurfacesTheyAreSaidToBe) {
  for (const std::string_view shape : kScannedShapes) {
    for (const bool holes : {false, true}) {
      const ScanOfShape scan = scan_of_shape({.shape = shape, .holes = holes});
      const MeshValidity validity = check_mesh(scan.surface.view());
      EXPECT_TRUE(validity.valid()) << scan.name;
      EXPECT_EQ(topology_of(scan.surface.view()), known(shape, holes)) << scan.name;
      EXPECT_GT(scan.points.size(), 4000u) << scan.name;
    }
  }
}

TEST(ScannedShapes, PointsLieOnTheSurface) {
  for (const Density density : {Density::kEven, Density::kGraded, Density::kLines}) {
    const ScanOfShape scan = scan_of_shape({.shape = "torus", .density = density});
    const ExactMesh surface(scan.surface.view());
    for (const Point& p : scan.points) EXPECT_LT(surface.distance(p).upper, 1e-9) << scan.name;
  }
}

// The estimate means the side of the square that a point has; points at least 1 apart and as dense
// as they can be thrown have about 1.3.
TEST(ScanEstimate, TellsSpacingAndNoise) {
  for (const std::string_view shape : kScannedShapes) {
    for (const double noise : {0.0, 0.1, 0.25, 0.5}) {
      const ScanOfShape scan = scan_of_shape({.shape = shape, .noise = noise});
      const ScanEstimate estimate = estimate_scan(scan.points);
      EXPECT_NEAR(estimate.spacing, 1.32, 0.08) << scan.name;
      EXPECT_NEAR(estimate.noise, noise, 0.1 * noise + 0.06) << scan.name;
    }
  }
}

// By hand: the greater of half the spacing and six times the noise, to two digits and rounded up.
TEST(ScanEstimate, SuggestsATolerance) {
  EXPECT_DOUBLE_EQ(*suggested_tolerance({.spacing = 0.00693, .noise = 5.6e-5}), 0.0035);
  EXPECT_DOUBLE_EQ(*suggested_tolerance({.spacing = 0.174, .noise = 0.0344}), 0.21);
  EXPECT_DOUBLE_EQ(*suggested_tolerance({.spacing = 198.2, .noise = 0}), 100);
  EXPECT_DOUBLE_EQ(*suggested_tolerance({.spacing = 20, .noise = 0}), 10);
  EXPECT_FALSE(suggested_tolerance({.spacing = 0, .noise = 0}));
}

TEST(ScanEstimate, ScalesWithTheScan) {
  std::vector<Point> points = scan_of_shape({.shape = "box", .noise = 0.1}).points;
  const ScanEstimate before = estimate_scan(points);
  for (Point& p : points) p *= 1024;
  const ScanEstimate after = estimate_scan(points);
  EXPECT_DOUBLE_EQ(after.spacing, 1024 * before.spacing);
  EXPECT_NEAR(after.noise, 1024 * before.noise, 1e-9 * after.noise);
}

TEST(ScanEstimate, IsNothingForTooFewPoints) {
  const std::vector<Point> two = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(estimate_scan(two).spacing, 0);
}

}  // namespace
}  // namespace emax::test
