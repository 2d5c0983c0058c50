#include <gtest/gtest.h>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/scan_estimate.h"
#include "host/parameters/descriptions.h"
#include "host/reconstruct/reconstruction.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/host/support/scanned_shapes.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

TriangleMesh implicit(const std::vector<Point>& points, double least_reach = 0) {
  ParameterValues values(Imls::parameters());
  values.set(Imls::kLeastReach, least_reach);
  return reconstruct(Imls::kName, points, values).mesh;
}

// As it is contoured, without a repair.
TEST(ImplicitSurface, IsTheScannedOneWithItsHolesAndBorders) {
  for (const std::string_view shape : {"sphere", "torus", "sheet"}) {
    for (const double noise : {0.0, 0.25}) {
      const ScanOfShape scan = scan_of_shape({.shape = shape, .noise = noise, .holes = true});
      const TriangleMesh mesh = implicit(scan.points);
      EXPECT_EQ(topology_of(mesh.view()), topology_of(scan.surface.view())) << scan.name;
      EXPECT_TRUE(check_mesh(mesh.view()).valid()) << scan.name;
      const ExactMesh truth(scan.surface.view());
      for (const Point& p : mesh.vertices) {
        EXPECT_LT(truth.distance(p).upper, 2.5)
            << scan.name;  // it goes beyond a border by a little
      }
      const ExactMesh made(mesh.view());
      double squares = 0;
      const std::vector<Point> samples = points_on(scan.surface, 0.5, 1);
      for (const Point& p : samples) squares += std::pow(made.distance(p).upper, 2);
      EXPECT_LT(std::sqrt(squares / static_cast<double>(samples.size())), 0.06 + 0.5 * noise)
          << scan.name;
    }
  }
}

// Poisson's own surface is closed.
TEST(TrimmedPoisson, EndsWhereTheScanEnds) {
  const ScanOfShape scan = scan_of_shape({.shape = "sheet", .noise = 0.1});
  ParameterValues values(Poisson::parameters());
  values.set(Poisson::kDepth, 6);
  const TriangleMesh mesh = reconstruct(Poisson::kName, scan.points, values).mesh;
  const ExactMesh truth(scan.surface.view());
  for (const Point& p : mesh.vertices) EXPECT_LT(truth.distance(p).upper, 6);
}

TEST(ImplicitSurface, FacesOutward) {
  EXPECT_GT(signed_volume(implicit(scan_of_shape({.shape = "sphere"}).points)), 0);
}

TEST(ImplicitSurface, LeavesThinSlotsOpen) {
  const ScanOfShape scan = scan_of_shape({.shape = "slots", .noise = 0.1});
  EXPECT_EQ(topology_of(implicit(scan.points).view()), topology_of(scan.surface.view()));
}

TEST(ImplicitSurface, SmoothsWhatItsReachIsWidenedFor) {
  const ScanOfShape scan = scan_of_shape({.shape = "sphere", .noise = 0.5});
  const ExactMesh truth(scan.surface.view());
  const auto roughness = [&](const TriangleMesh& mesh) {
    double squares = 0;
    for (const Point& p : mesh.vertices) squares += std::pow(truth.distance(p).upper, 2);
    return std::sqrt(squares / static_cast<double>(mesh.vertices.size()));
  };
  const double narrow = roughness(implicit(scan.points)),
               wide = roughness(implicit(scan.points, 5));
  EXPECT_LT(wide, 0.8 * narrow);
}

TEST(ImplicitSurface, RepeatsItsBytesAndTakesFewPoints) {
  const std::vector<Point> points = square_cloud(20, 0, 3);
  EXPECT_TRUE(same_bytes(implicit(points), implicit(points)));
  const std::vector<Point> few(points.begin(), points.begin() + 30);
  EXPECT_NO_THROW(implicit(few));
}

}  // namespace
}  // namespace emax::test
