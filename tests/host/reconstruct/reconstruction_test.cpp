#include "host/reconstruct/reconstruction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/geometry/mesh_validity.h"
#include "host/parameters/descriptions.h"
#include "sw_model/base/error.h"
#include "tests/host/support/surface_clouds.h"
#include "tests/support/messages.h"

namespace emax::test {
namespace {

ParameterValues standards(std::string_view method) {
  ParameterValues values(method_named(method).parameters);
  if (method == "hoppe") values.set(Hoppe::kResolution, 32);
  if (method == "poisson") values.set(Poisson::kDepth, 6);
  return values;
}

Reconstruction reconstruct(std::string_view method, const std::vector<Point>& points) {
  return emax::reconstruct(method, points, standards(method));
}

// Greatest distance of a vertex from the sphere of radius 1 around `centre`.
double departure(const TriangleMesh& mesh, const Point& centre = Point::Zero()) {
  double greatest = 0;
  for (const Point& p : mesh.vertices) {
    greatest = std::max(greatest, std::abs((p - centre).norm() - 1));
  }
  return greatest;
}

void expect_closed_sphere(const TriangleMesh& mesh, double tolerance) {
  const MeshValidity validity = check_mesh(mesh.view());
  EXPECT_EQ(validity.boundary_edges, 0u);
  EXPECT_EQ(validity.non_manifold_edges, 0u);
  EXPECT_EQ(validity.inconsistent_edges, 0u);
  EXPECT_EQ(validity.components, 1u);
  EXPECT_NEAR(signed_volume(mesh), 4 * std::numbers::pi / 3, 0.1);
  EXPECT_LT(departure(mesh), tolerance);
}

// What reconstruct() says of points that it refuses.
std::string refusal(const std::vector<Point>& points) {
  return message_of([&] { reconstruct("gp3", points); });
}

TEST(ReconstructionParameters, HaveStandardsInTheirDomainsAndNamesOfTheirOwn) {
  for (const MethodDescription& method : reconstruction_methods()) {
    std::set<std::string> names;
    for (const Parameter& spec : method.parameters) {
      EXPECT_TRUE(names.insert(spec.name).second) << spec.name;
      EXPECT_LT(spec.lower, spec.upper) << spec.name;
      EXPECT_LE(spec.lower, spec.standard) << spec.name;
      EXPECT_LE(spec.standard, spec.upper) << spec.name;
    }
    EXPECT_EQ(std::ranges::count(method_runs(), method.name, &MethodRun::name), 1) << method.name;
  }
  EXPECT_EQ(method_runs().size(), reconstruction_methods().size());
  EXPECT_THROW(method_named("ball pivoting"), Error);
  EXPECT_THROW(emax::reconstruct("ball pivoting", sphere_cloud(50), {}), Error);
}

TEST(Gp3, ClosesASphereOnTheCloudsOwnPoints) {
  const std::vector<Point> cloud = sphere_cloud(800);
  const Reconstruction result = reconstruct("gp3", cloud);
  expect_closed_sphere(result.mesh, 2 * kGrain);
  EXPECT_EQ(result.mesh.triangles.size(), 2 * cloud.size() - 4);
  EXPECT_EQ(result.mesh.vertices, cloud);
  EXPECT_EQ(result.unmeshed_points, 0u);
}

TEST(Gp3, KeepsMillimetresTenThousandKilometresAway) {
  const Point far(1e7, -1e7, 5e6);
  const std::vector<Point> cloud = torus_cloud(40, 20);
  const Reconstruction near = reconstruct("gp3", cloud);
  Reconstruction there = reconstruct("gp3", moved(cloud, far));
  EXPECT_EQ(there.mesh.triangles, near.mesh.triangles);
  EXPECT_EQ(moved(there.mesh.vertices, -far), near.mesh.vertices);
}

TEST(Gp3, CountsFarPointsAndTheirDuplicates) {
  std::vector<Point> cloud = sphere_cloud(800);
  cloud.push_back(cloud[7]);  // on a vertex: meshed
  cloud.push_back({3, 0, 0});
  cloud.push_back({3, 0, 0});
  EXPECT_EQ(reconstruct("gp3", cloud).unmeshed_points, 2u);
}

TEST(Gp3, MeshesTheSquareAndLeavesItsHole) {
  constexpr std::uint64_t kSeed = 4;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const TriangleMesh mesh = reconstruct("gp3", square_cloud(30, 0.5, kSeed)).mesh;
  const MeshValidity validity = check_mesh(mesh.view());
  EXPECT_EQ(validity.non_manifold_edges, 0u);
  EXPECT_EQ(validity.inconsistent_edges, 0u);
  EXPECT_GT(validity.boundary_edges, 4u * 25);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    EXPECT_GT(((a + b + c) / 3).norm(), 0.4);
  }
}

// Along the axes, turned and sheared: edges are collinear, exactly or but for roundings.
TEST(Gp3, MeshesAGridWhole) {
  constexpr int kSide = 30;
  const std::vector<std::pair<Point, Point>> steps = {{{1, 0, 0}, {0, 1, 0}},
                                                      {{0, 0.1, 0}, {0, 0, 0.1}},
                                                      {{0.1, 0, 0.03}, {0, 0.1, 0.07}},
                                                      {{0.8, 0.6, 0}, {0, 0, 1}},
                                                      {{1, 0, 0.5}, {0, 1, 0}}};
  for (std::size_t s = 0; s < steps.size(); ++s) {
    SCOPED_TRACE(s);
    std::vector<Point> cloud;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        cloud.push_back(i * steps[s].first + j * steps[s].second);
      }
    }
    const Reconstruction result = reconstruct("gp3", cloud);
    const MeshValidity validity = check_mesh(result.mesh.view());
    EXPECT_EQ(result.unmeshed_points, 0u);
    EXPECT_EQ(validity.components, 1u);
    EXPECT_EQ(validity.non_manifold_edges, 0u);
    EXPECT_EQ(validity.boundary_edges, 4u * (kSide - 1));
    EXPECT_EQ(result.mesh.triangles.size(), 2u * (kSide - 1) * (kSide - 1));
    EXPECT_EQ(validity.self_intersections, 0u);
  }
}

TEST(Hoppe, WeldsASphere) {
  const Reconstruction result = reconstruct("hoppe", sphere_cloud(3000));
  expect_closed_sphere(result.mesh, 0.02);
  EXPECT_LT(result.mesh.vertices.size(), result.mesh.triangles.size());
}

TEST(Hoppe, StaysPreciseFarFromTheOrigin) {
  const Point far(1e7, -1e7, 5e6);
  const Reconstruction near = reconstruct("hoppe", sphere_cloud(3000));
  const Reconstruction there = reconstruct("hoppe", moved(sphere_cloud(3000), far));
  EXPECT_EQ(there.mesh.triangles, near.mesh.triangles);
  EXPECT_LT(departure(there.mesh, far), 0.02);
}

TEST(Hoppe, ContoursAFlatCloud) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const TriangleMesh mesh = reconstruct("hoppe", square_cloud(40, 0, kSeed)).mesh;
  double flat = 0;
  for (const Point& p : mesh.vertices) flat = std::max(flat, std::abs(p.z()));
  EXPECT_LT(flat, 1e-3);
  EXPECT_EQ(check_mesh(mesh.view()).inconsistent_edges, 0u);
}

// The only one in this program: Poisson runs once in a process.
TEST(Poisson, ClosesASphereFarFromTheOrigin) {
  const Point far(1e7, -1e7, 5e6);
  TriangleMesh mesh = reconstruct("poisson", moved(sphere_cloud(2000), far)).mesh;
  mesh.vertices = moved(mesh.vertices, -far);
  expect_closed_sphere(mesh, 0.03);
}

TEST(Reconstruction, RepeatsItsBytes) {
  for (const std::string_view method : {"gp3", "hoppe"}) {
    const std::vector<Point> cloud = torus_cloud(30, 14);
    EXPECT_TRUE(same_bytes(reconstruct(method, cloud).mesh, reconstruct(method, cloud).mesh))
        << method;
  }
}

// All searches ask for more neighbours than there are points.
TEST(Reconstruction, TakesFewerPointsThanNeighbours) {
  const std::vector<Point> octahedron = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                         {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  for (const std::string_view method : {"gp3", "hoppe"}) {
    for (const int k : {3, 40}) {
      ParameterValues values = standards(method);
      values.set(Normals::kNeighbours, k);
      values.set(Normals::kOrientationNeighbours, k);
      EXPECT_GT(emax::reconstruct(method, octahedron, values).mesh.triangles.size(), 0u)
          << method << " k " << k;
    }
  }
}

// Two spheres side by side: a graph of near neighbours keeps them apart, a wider one joins the
// points that face each other and so turns one sphere inward.
TEST(Reconstruction, OrientationSpreadsToItsNeighbours) {
  const std::vector<Point> one = sphere_cloud(1000);
  std::vector<Point> cloud = one;
  for (const Point& p : one) cloud.push_back(p + Point(2.15, 0, 0));
  ParameterValues values = standards("gp3");
  values.set(Gp3::kSurfaceAngle, 45);
  const auto volume = [&](int orientation_k) {
    values.set(Normals::kOrientationNeighbours, orientation_k);
    return signed_volume(emax::reconstruct("gp3", cloud, values).mesh);
  };
  EXPECT_NEAR(volume(6), 2 * 4 * std::numbers::pi / 3, 0.2);
  EXPECT_NEAR(volume(40), 0, 0.2);
}

TEST(Reconstruction, RefusesWhatSpansNoSurface) {
  EXPECT_NE(refusal({}).find("only 0 points"), std::string::npos);
  EXPECT_NE(refusal({{0, 0, 0}, {1, 0, 0}}).find("only 2 points"), std::string::npos);
  EXPECT_NE(refusal(std::vector<Point>(9, Point(1, 2, 3))).find("only 1 distinct"),
            std::string::npos);
  std::vector<Point> line;
  for (int i = 0; i < 50; ++i) line.emplace_back(i, 2 * i, 0);
  EXPECT_NE(refusal(line).find("are they on one line"), std::string::npos);
}

TEST(Reconstruction, NamesAMissingParameter) {
  ParameterValues values = standards("gp3");
  values.by_name().erase("gp3.mu");
  const std::string message =
      message_of([&] { emax::reconstruct("gp3", sphere_cloud(50), values); });
  EXPECT_NE(message.find("gp3.mu"), std::string::npos) << message;
}

}  // namespace
}  // namespace emax::test
