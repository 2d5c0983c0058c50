// What a certificate calls a surface (docs/numerics.md), judged by CGAL: on scans and tolerances
// drawn at random, from far below the distance between points to far above it.
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/files/mesh_file.h"
#include "host/geometry/merge_vertices.h"
#include "tests/host/app/program.h"
#include "tests/host/support/surface_clouds.h"
#include "tests/support/cgal_mesh.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

using nlohmann::json;
namespace pmp = CGAL::Polygon_mesh_processing;

// As a certificate tells it.
json topology_in_json(const CgalMesh& mesh) {
  const MeshTopology topology = topology_by_cgal(mesh);
  return {{"components", topology.components},
          {"border_loops", topology.border_loops},
          {"genus", topology.genus}};
}

std::size_t intersecting_pairs(const CgalMesh& mesh) {
  std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  return pairs.size();
}

// Corners and random points of every triangle, more in larger ones.
std::vector<Point> samples(const TriangleMesh& mesh, std::uint64_t seed) {
  constexpr double kSamples = 40'000;
  Random random(seed);
  std::vector<double> areas;
  double whole = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    areas.push_back((b - a).cross(c - a).norm());
    whole += areas.back();
  }
  std::vector<Point> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    points.insert(points.end(), {a, b, c, (a + b + c) / 3});
    for (double i = 0; i < kSamples * areas[t] / whole; ++i) {
      const double s = std::sqrt(random.uniform(0, 1)), r = random.uniform(0, 1);
      points.push_back((1 - s) * a + s * (1 - r) * b + s * r * c);
    }
  }
  return points;
}

struct Drawn {
  std::vector<Point> points;
  double epsilon;
  std::string name;
};

// Every shape in every decade of the tolerance, in distances between points.
Drawn draw(std::uint64_t seed) {
  Random random(seed);
  Drawn drawn;
  double area = 0;
  switch (seed % 3) {
    case 0:
      drawn.name = "bumpy sphere";
      drawn.points = bumpy_sphere(4, 4, 900, seed).cloud;
      area = 4 * std::numbers::pi;
      break;
    case 1:
      drawn.name = "torus";
      drawn.points = torus_cloud(48, 20);
      area = 4 * 0.4 * std::numbers::pi * std::numbers::pi;
      break;
    default:
      drawn.name = "wavy sheet with a hole";
      drawn.points = square_cloud(30, 0.3, seed);
      for (Point& p : drawn.points) p.z() = 0.2 * std::sin(3 * p.x()) * std::cos(2 * p.y());
      area = 4;
  }
  const double decade = static_cast<double>(seed / 3 % 3) - 2;
  const double spacing = std::sqrt(area / static_cast<double>(drawn.points.size()));
  const double spacings = std::pow(10.0, decade + random.uniform(0, 1));
  drawn.epsilon = spacings * spacing;
  if (random.below(2) == 0) {
    const double noise = std::min(drawn.epsilon / 5, spacing / 5);
    for (Point& p : drawn.points) p += noise * random.point(-1, 1);
    drawn.name += " with noise";
  }
  drawn.name += fmt::format(", tolerance {:.3g} spacings, seed {}", spacings, seed);
  return drawn;
}

class CertifiedSurface : public testing::TestWithParam<std::uint64_t> {
 protected:
  void expect_surface(const std::string& mesh_name, const std::string& reference_name,
                      std::span<const Point> points) {
    const json c = json::parse(file_text(folder_ / (mesh_name + ".certificate.json")));
    const TriangleMesh mesh = read_mesh(folder_ / mesh_name);
    const TriangleMesh reference = read_mesh(folder_ / reference_name);
    CgalMesh cgal = cgal_mesh(mesh), cgal_reference = cgal_mesh(reference);
    const std::size_t intersections = intersecting_pairs(cgal);
    EXPECT_EQ(c.at("validity").at("self_intersections"), intersections);
    EXPECT_EQ(c.at("valid"), intersections == 0);
    EXPECT_LE(intersections, intersecting_pairs(cgal_reference));
    EXPECT_EQ(topology_in_json(cgal), c.at("topology"));
    EXPECT_EQ(topology_in_json(cgal_reference), c.at("reference").at("topology"));
    EXPECT_EQ(c.at("topology"), c.at("reference").at("topology"));
    const double epsilon = c.at("epsilon").get<double>() * (1 + 1e-9);
    EXPECT_LE(farthest(points, cgal), epsilon);
    EXPECT_LE(farthest(samples(mesh, 1), cgal_reference), epsilon);
    EXPECT_LE(farthest(samples(reference, 2), cgal), epsilon);
    EXPECT_EQ(run_emax({"verify", mesh_name + ".certificate.json"}, folder_.path()).exit_code, 0);
  }

  TemporaryFolder folder_;
};

TEST_P(CertifiedSurface, HoldsInThreeDirectionsAndInTopology) {
  const Drawn drawn = draw(GetParam());
  SCOPED_TRACE(drawn.name);
  std::ofstream file(folder_ / "scan.xyz");
  for (const Point& p : drawn.points) file << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  file.close();
  const std::string epsilon = fmt::format("{}", drawn.epsilon);
  const ProgramRun optimized = run_emax({"optimize", "scan.xyz", "--max-error", epsilon, "-o",
                                         "mesh.ply", "--budget", "1", "--no-polish", "--jobs", "1"},
                                        folder_.path());
  ASSERT_EQ(optimized.exit_code, 0) << optimized.output << optimized.errors;
  expect_surface("mesh.ply", "mesh.ply.reference.ply", drawn.points);

  const TriangleMesh given = read_mesh(folder_ / "mesh.ply.reference.ply");
  write_mesh(folder_ / "given.off", given);
  const ProgramRun decimated =
      run_emax({"decimate", "given.off", "--max-error", epsilon, "-o", "less.ply"}, folder_.path());
  ASSERT_EQ(decimated.exit_code, 0) << decimated.output << decimated.errors;
  expect_surface("less.ply", "given.off", given.vertices);
}

INSTANTIATE_TEST_SUITE_P(Drawn, CertifiedSurface, testing::Range<std::uint64_t>(0, 18));

// A mesh as a soup: each triangle with corners of its own, so that CGAL takes what is not manifold.
CgalMesh soup(const TriangleMesh& mesh) {
  TriangleMesh apart;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corners = mesh.view().corners(t);
    if ((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() == 0) continue;
    const auto first = static_cast<std::uint32_t>(apart.vertices.size());
    apart.vertices.insert(apart.vertices.end(), corners.begin(), corners.end());
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  return cgal_mesh(apart);
}

// Meshes of CGAL's demos (`./dev data`): polygons, several pieces, borders, vertices of no
// triangle, repeated and degenerate triangles, self-intersections, edges and vertices that are not
// manifold.
class EverydayMeshes : public CertifiedSurface {};

constexpr std::uint64_t kShares = 8;  // so that they run side by side
constexpr std::uintmax_t kMostBytes = 400'000;

TEST_P(EverydayMeshes, AreDecimatedUnderTheBoundsOrRefused) {
  const std::filesystem::path meshes = EMAX_DATA_FOLDER "/meshes";
  const std::vector<std::string> names = files_in(meshes);
  ASSERT_GE(names.size(), 130) << "./dev data fetches them";
  constexpr std::array kPercent = {0.05, 0.3, 1.0, 4.0};
  std::size_t decimated = 0;
  for (std::size_t i = GetParam(); i < names.size(); i += kShares) {
    const std::filesystem::path file = meshes / names[i];
    if (std::filesystem::file_size(file) > kMostBytes) continue;
    const double percent = kPercent[i / kShares % kPercent.size()];
    SCOPED_TRACE(fmt::format("{} at {} %", names[i], percent));
    std::filesystem::copy_file(file, folder_ / names[i]);
    const ProgramRun run = run_emax(
        {"decimate", names[i], "--max-error", fmt::format("{}%", percent), "-o", "less.ply"},
        folder_.path());
    if (names[i] == "prim.off") {  // of eight faces, where its header says seven
      EXPECT_EQ(run.exit_code, 1);
      EXPECT_NE(run.errors.find("prim.off: line 24"), std::string::npos) << run.errors;
      std::filesystem::remove(folder_ / names[i]);
      continue;
    }
    ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
    ++decimated;
    // Where the mesh was not manifold, the reference is it cut apart: the same surface.
    TriangleMesh given = read_mesh(file);
    drop_unused_vertices(given.vertices, given.triangles);
    const bool was_cut = std::filesystem::exists(folder_ / "less.ply.reference.ply");
    const std::string reference = was_cut ? "less.ply.reference.ply" : names[i];
    expect_surface("less.ply", reference, given.vertices);
    if (was_cut) {
      const TriangleMesh cut = read_mesh(folder_ / reference);
      EXPECT_LE(farthest(samples(cut, 3), soup(given)), 1e-9);
      EXPECT_LE(farthest(samples(given, 4), soup(cut)), 1e-9);
    }
    for (const std::string& made : files_in(folder_.path())) {
      std::filesystem::remove_all(folder_ / made);
    }
  }
  EXPECT_GE(decimated, 10);
}

INSTANTIATE_TEST_SUITE_P(Shares, EverydayMeshes, testing::Range<std::uint64_t>(0, kShares));

// What the cases above are judged by sees a hole between the points.
TEST(CertifiedSurfaceFault, CgalSeesAHole) {
  const Stimulus whole = bumpy_sphere(8, 12, 0, 1);
  const TriangleMesh reference{whole.vertices, whole.triangles};
  TriangleMesh holed = reference;
  holed.triangles.erase(holed.triangles.begin() + 40);
  CgalMesh cgal = cgal_mesh(holed), cgal_reference = cgal_mesh(reference);
  EXPECT_EQ(farthest(holed.vertices, cgal), 0);
  EXPECT_LT(farthest(samples(holed, 1), cgal_reference), 1e-12);
  EXPECT_GT(farthest(samples(reference, 1), cgal), 0.01);
  EXPECT_NE(topology_in_json(cgal), topology_in_json(cgal_reference));
}

}  // namespace
}  // namespace emax::test
