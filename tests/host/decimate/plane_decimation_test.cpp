#include <gtest/gtest.h>

#include <memory>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/decimation.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

constexpr double kWithin = 0.03, kRoughness = 0.006;

TriangleMesh roughened(TriangleMesh mesh, double noise, std::uint64_t seed = 1) {
  Random random(named_seed("noisy planes", seed));
  for (Point& v : mesh.vertices) v += random.point(-noise, noise);
  return mesh;
}

DecimationSettings with_planes(const TriangleMesh& mesh, double epsilon = kWithin) {
  DecimationSettings settings = with(epsilon);
  settings.planes = std::make_shared<const PlaneParts>(find_plane_parts(mesh.vertices, epsilon, 1));
  return settings;
}

TriangleMesh decimated(const TriangleMesh& mesh, const DecimationSettings& settings) {
  return BoundedDecimator(mesh, mesh.vertices).run(settings).mesh;
}

// In the three directions, by code that is not the decimator's.
void expect_bounds_kept(const TriangleMesh& mesh, const TriangleMesh& reference, double epsilon) {
  SurfaceDistanceOptions options;
  options.relative = 0;
  options.limit = epsilon;
  EXPECT_TRUE(certify(reference.vertices, mesh.view(), {}).within(epsilon));
  EXPECT_TRUE(surface_distance(mesh.view(), ExactMesh(reference.view()), options).within(epsilon));
  EXPECT_TRUE(surface_distance(reference.view(), ExactMesh(mesh.view()), options).within(epsilon));
  EXPECT_TRUE(check_mesh(mesh.view()).valid());
  EXPECT_EQ(topology_of(mesh.view()), topology_of(reference.view()));
}

// How many vertices lie on none of the planes.
std::size_t off_planes(const TriangleMesh& mesh, const std::vector<Plane>& planes) {
  return static_cast<std::size_t>(std::ranges::count_if(mesh.vertices, [&](const Point& v) {
    return std::ranges::none_of(
        planes, [&](const Plane& p) { return std::abs(p.signed_distance(v)) < 1e-9; });
  }));
}

TEST(PlaneDecimation, LeavesANoisyCubeItsTwelveTrianglesOnItsPlanes) {
  const TriangleMesh mesh = roughened(cube(14), kRoughness);
  const DecimationSettings settings = with_planes(mesh);
  ASSERT_EQ(settings.planes->planes.size(), 6u);
  const TriangleMesh result = decimated(mesh, settings);
  expect_bounds_kept(result, mesh, kWithin);
  EXPECT_EQ(result.triangles.size(), 12u);
  for (const Point& v : result.vertices) {
    const auto through = std::ranges::count_if(settings.planes->planes, [&](const Plane& p) {
      return std::abs(p.signed_distance(v)) < 1e-9;
    });
    EXPECT_EQ(through, 3);
  }
}

TEST(PlaneDecimation, KeepsAnOpenSheetOnItsPlane) {
  const TriangleMesh mesh = roughened(sheet(24, 0), kRoughness);
  const DecimationSettings settings = with_planes(mesh);
  ASSERT_EQ(settings.planes->planes.size(), 1u);
  const TriangleMesh result = decimated(mesh, settings);
  expect_bounds_kept(result, mesh, kWithin);
  EXPECT_EQ(off_planes(result, settings.planes->planes), 0u);
}

TEST(PlaneDecimation, WithoutAPlaneChangesNoByte) {
  const TriangleMesh mesh = bumpy(24, 40);
  const DecimationSettings settings = with_planes(mesh, 0.003);
  ASSERT_TRUE(settings.planes->planes.empty());
  EXPECT_TRUE(same_bytes(decimated(mesh, settings), decimated(mesh, with(0.003))));
}

TEST(PlaneDecimation, HoldsItsBoundsWherePlanesDoNot) {
  const TriangleMesh mesh = roughened(cube(12), kRoughness);
  DecimationSettings settings = with_planes(mesh);
  auto wrong = std::make_shared<PlaneParts>(*settings.planes);
  for (Plane& plane : wrong->planes) {
    plane.offset += 0.9 * kWithin;
    plane.normal = (plane.normal + Point(0.01, 0.02, 0.01)).normalized();
  }
  settings.planes = wrong;
  expect_bounds_kept(decimated(mesh, settings), mesh, kWithin);
}

// Planes so far from the points that no vertex can lie on them.
TEST(PlaneDecimation, ComesNearerToPlanesThatItCannotReach) {
  const TriangleMesh mesh = roughened(cube(12), kRoughness);
  DecimationSettings settings = with_planes(mesh);
  auto wrong = std::make_shared<PlaneParts>(*settings.planes);
  for (Plane& plane : wrong->planes) plane.offset += (plane.offset > 0 ? 0.9 : -0.9) * kWithin;
  settings.planes = wrong;
  const auto mean_distance = [&](const TriangleMesh& result) {
    double sum = 0;
    for (const Point& v : result.vertices) {
      double nearest = 1;
      for (const Plane& p : wrong->planes) {
        nearest = std::min(nearest, std::abs(p.signed_distance(v)));
      }
      sum += nearest / static_cast<double>(result.vertices.size());
    }
    return sum;
  };
  const TriangleMesh result = decimated(mesh, settings);
  expect_bounds_kept(result, mesh, kWithin);
  EXPECT_GT(off_planes(result, wrong->planes), 0u);
  EXPECT_LT(mean_distance(result), 0.7 * mean_distance(decimated(mesh, with(kWithin))));
}

TEST(PlaneDecimation, KeepsWallsApartThatAreCloserThanTheBound) {
  TriangleMesh slab = cube(14);
  for (Point& v : slab.vertices) v.z() *= 0.4 * kWithin;
  const TriangleMesh mesh = roughened(slab, 0.05 * kWithin);
  const TriangleMesh result = decimated(mesh, with_planes(mesh));
  expect_bounds_kept(result, mesh, kWithin);
}

TEST(PlaneDecimation, KeepsItsBoundsOnPlanesAmidCurves) {
  const TriangleMesh mesh = joined(bumpy(10, 15), roughened(cube(14), kRoughness), {4, 0, 0});
  const DecimationSettings settings = with_planes(mesh);
  EXPECT_GE(settings.planes->planes.size(), 6u);
  expect_bounds_kept(decimated(mesh, settings), mesh, kWithin);
}

TEST(PlaneDecimation, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = joined(bumpy(10, 15), roughened(cube(14), kRoughness), {4, 0, 0});
  DecimationSettings settings = with_planes(mesh);
  const TriangleMesh one = decimated(mesh, settings);
  settings.threads = 2;
  EXPECT_TRUE(same_bytes(decimated(mesh, settings), one));
}

TEST(PlaneDecimation, SpreadsTheErrorWhereTrianglesCountMost) {
  const TriangleMesh mesh = can(60, 20);
  DecimationSettings settings = with_planes(mesh, 0.02);
  ASSERT_GE(settings.planes->planes.size(), 2u);
  const TriangleMesh plain = decimated(mesh, settings);
  settings.spread_on_planes = true;
  const TriangleMesh spread = decimated(mesh, settings);
  expect_bounds_kept(spread, mesh, 0.02);
  EXPECT_LT(spread.triangles.size(), plain.triangles.size());
  settings.threads = 2;
  EXPECT_TRUE(same_bytes(decimated(mesh, settings), spread));
}

TEST(PlaneDecimation, TakesTheFewerTrianglesOfBoth) {
  for (const std::uint64_t seed : {1, 2}) {
    const TriangleMesh mesh = joined(roughened(bumpy(10, 15), 0.01, seed),
                                     roughened(cube(12), kRoughness, seed), {4, 0, 0});
    DecimationSettings settings = with_planes(mesh);
    settings.spread_on_planes = true;
    const std::size_t with_them = decimated(mesh, settings).triangles.size();
    const std::size_t without = decimated(mesh, with(kWithin)).triangles.size();
    settings.without_planes_too = true;
    const TriangleMesh best = decimated(mesh, settings);
    EXPECT_EQ(best.triangles.size(), std::min(with_them, without));
    expect_bounds_kept(best, mesh, kWithin);
  }
}

// Facets of which no ten are on one plane, all within the bound of one.
TEST(PlaneDecimation, LaysTinyFacetsWithinTheBoundOnOnePlane) {
  TriangleMesh mesh = sheet(70, 0);
  Random random(named_seed("tiny facets", 1));
  for (Point& v : mesh.vertices) v.z() += random.uniform(-0.4, 0.4) * kWithin;
  const DecimationSettings settings = with_planes(mesh);
  ASSERT_EQ(settings.planes->planes.size(), 1u);
  const TriangleMesh result = decimated(mesh, settings);
  expect_bounds_kept(result, mesh, kWithin);
  EXPECT_EQ(off_planes(result, settings.planes->planes), 0u);
  EXPECT_LT(result.triangles.size(), 10u);
}

TEST(PlaneDecimation, FindsNoPlaneAmongTinyFacetsBeyondTheBound) {
  TriangleMesh mesh = sheet(30, 0);
  Random random(named_seed("tiny facets", 2));
  for (Point& v : mesh.vertices) v.z() += random.uniform(-4, 4) * kWithin;
  const DecimationSettings settings = with_planes(mesh);
  EXPECT_TRUE(settings.planes->planes.empty());
  EXPECT_TRUE(same_bytes(decimated(mesh, settings), decimated(mesh, with(kWithin))));
}

// A wall that was found in noise: planes at any angle through a surface that follows none of them.
TEST(PlaneDecimation, HoldsItsBoundsOnPlanesThroughNoise) {
  const TriangleMesh mesh = roughened(bumpy(14, 20), 0.01);
  Random random(named_seed("planes through noise", 1));
  auto wrong = std::make_shared<PlaneParts>();
  wrong->points = mesh.vertices;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Point normal = random.point(-1, 1).normalized();
    wrong->planes.push_back({normal, normal.dot(mesh.vertices[20 * i + 7])});
    wrong->support.push_back({});
  }
  for (const Point& v : mesh.vertices) {
    wrong->plane_of.push_back(PlaneParts::kNoPlane);
    for (std::uint32_t i = 0; i < 8; ++i) {
      if (std::abs(wrong->planes[i].signed_distance(v)) < kWithin) wrong->plane_of.back() = i;
    }
  }
  DecimationSettings settings = with(kWithin);
  settings.planes = wrong;
  expect_bounds_kept(decimated(mesh, settings), mesh, kWithin);
}

DecimationSettings with_shapes(const TriangleMesh& mesh, double epsilon) {
  DecimationSettings settings = with(epsilon);
  settings.planes = std::make_shared<const PlaneParts>(
      find_plane_parts(mesh.vertices, epsilon, 1, [] {}, {.curved = true}));
  return settings;
}

// On how many of the shapes each vertex lies: of 0, of 1 and so on.
std::vector<std::size_t> shapes_through(const TriangleMesh& mesh, std::span<const Shape> shapes) {
  std::vector<std::size_t> vertices(shapes.size() + 1);
  for (const Point& v : mesh.vertices) {
    ++vertices[static_cast<std::size_t>(
        std::ranges::count_if(shapes, [&](const Shape& s) { return distance(s, v) < 1e-9; }))];
  }
  return vertices;
}

// A can as a scan shows it: its rims are circles where a plane and the cylinder meet.
struct NoisyCan {
  static constexpr double kBound = 0.04;
  TriangleMesh mesh = roughened(can(80, 24), 0.004);
  DecimationSettings settings = with_shapes(mesh, kBound);
  std::vector<Shape> shapes = settings.planes->shapes();
};

TEST(PlaneDecimation, PutsTheVerticesOfACanOnItsCylinderAndItsRims) {
  const NoisyCan noisy;
  ASSERT_EQ(noisy.settings.planes->planes.size(), 2u);
  ASSERT_EQ(noisy.settings.planes->curved.size(), 1u);
  const TriangleMesh result = decimated(noisy.mesh, noisy.settings);
  expect_bounds_kept(result, noisy.mesh, NoisyCan::kBound);
  const std::vector<std::size_t> through = shapes_through(result, noisy.shapes);
  EXPECT_EQ(through[0], 0u);
  EXPECT_EQ(through[2], result.vertices.size());
  const std::vector<std::uint32_t> under =
      shapes_under(result, noisy.shapes, 1e-9, 2 * NoisyCan::kBound);
  EXPECT_TRUE(std::ranges::is_sorted(under));
  EXPECT_EQ(std::ranges::count(under, PlaneParts::kNoPlane), 0);
}

TEST(PlaneDecimation, PutsVerticesOnASphereWhereItHolds) {
  TriangleMesh ball = bumpy(24, 48);
  for (Point& v : ball.vertices) v = v.normalized() * (1 + 0.02 * (v.norm() - 1));
  DecimationSettings settings = with_shapes(ball, 0.05);
  ASSERT_EQ(settings.planes->curved.size(), 1u);
  const std::vector<Shape> shapes = settings.planes->shapes();
  const TriangleMesh result = decimated(ball, settings);
  expect_bounds_kept(result, ball, 0.05);
  EXPECT_GE(10 * shapes_through(result, shapes)[1], 9 * result.vertices.size());
}

TEST(PlaneDecimation, HoldsItsBoundsWhereCurvedShapesDoNot) {
  const NoisyCan noisy;
  auto wrong = std::make_shared<PlaneParts>(*noisy.settings.planes);
  auto& side = std::get<Cylinder>(wrong->curved.front());
  side.radius += 0.9 * NoisyCan::kBound;
  side.axis = (side.axis + Point(0.01, 0.02, 0)).normalized();
  DecimationSettings settings = noisy.settings;
  settings.planes = wrong;
  expect_bounds_kept(decimated(noisy.mesh, settings), noisy.mesh, NoisyCan::kBound);
}

TEST(PlaneDecimation, OnCurvedShapesIsTheSameForAnyNumberOfThreads) {
  const NoisyCan noisy;
  DecimationSettings settings = noisy.settings;
  const TriangleMesh one = decimated(noisy.mesh, settings);
  settings.threads = 3;
  EXPECT_TRUE(same_bytes(decimated(noisy.mesh, settings), one));
}

// Without edges, which would bring vertices onto planes again.
TEST(PlaneDecimationFault, ThatForgetsPlanesIsSeen) {
  const TriangleMesh mesh = roughened(sheet(24, 0), kRoughness);
  const DecimationSettings settings = with_planes(mesh);
  const DeliberateFault fault(Fault::kForgetsPlanes);
  EXPECT_GT(off_planes(decimated(mesh, settings), settings.planes->planes), 0u);
}

}  // namespace
}  // namespace emax::test
