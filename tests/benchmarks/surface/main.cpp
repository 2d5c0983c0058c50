// The reference surface of generated scans beside the surface that was scanned, one line a scan.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/geometry/mesh_topology.h"
#include "host/optimize/reference_fit.h"
#include "host/optimize/run_bound.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/host/support/scanned_shapes.h"

namespace emax {
namespace {

struct Options {
  std::vector<std::string> shapes{test::kScannedShapes.begin(), test::kScannedShapes.end()};
  std::vector<std::string> densities = {"even", "graded", "lines"};
  std::vector<double> noises = {0, 0.2, 0.5};  // of epsilon
  std::vector<std::string> kinds = {"plain", "holes", "outliers"};
  double epsilon = 0.5, scale = 1;
  std::uint64_t seed = 1;
  std::string method = kFitMethod, out, file;
};

struct Spread {
  double rms = 0, most = 0;  // 0.999 quantile
};

Spread distances(std::span<const Point> points, const TriangleMesh& mesh) {
  const ExactMesh exact(mesh.view());
  std::vector<double> all;
  for (const Point& p : points) all.push_back(exact.distance(p).upper);
  std::ranges::sort(all);
  Spread spread;
  for (const double d : all) spread.rms += d * d / static_cast<double>(all.size());
  spread.rms = std::sqrt(spread.rms);
  spread.most = all[static_cast<std::size_t>(0.999 * static_cast<double>(all.size() - 1))];
  return spread;
}

struct Row {
  DecimationBound bound;
  ReferenceFit fit;
  double seconds;
};

Row make(const test::ScanOfShape& scan, const Options& options) {
  Row row;
  OptimizeSettings settings;
  settings.method = options.method;
  settings.epsilon_back = options.epsilon;
  settings.jobs = 2;
  settings.output = "mesh.ply";
  const auto start = std::chrono::steady_clock::now();
  ErrorConstraint constraint(scan.points, options.epsilon, scan.outliers > 0 ? 0.02 : 0);
  row.bound = decimation_bound(scan.points, constraint, settings, &row.fit);
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.out.empty()) {
    const std::filesystem::path folder = options.out;
    std::filesystem::create_directories(folder);
    write_mesh(folder / (scan.name + ".reference.ply"), row.bound.reference);
    write_mesh(folder / (scan.name + ".cloud.ply"), {scan.points, {}});
  }
  return row;
}

std::string text_of(const MeshTopology& topology) {
  return fmt::format("{}/{}/{}", topology.components, topology.border_loops, topology.genus);
}

// Whether the topology is the truth's.
bool print_row(const test::ScanOfShape& scan, const Options& options) {
  const Row row = make(scan, options);
  const TriangleMesh& mesh = row.bound.reference;
  const MeshTopology made = topology_of(mesh.view());
  fmt::print("{:32} {:7} {:>9} {:5} {:9} {:5.1f}%", scan.name, scan.points.size(), text_of(made),
             row.fit.best().chain.method, mesh.triangles.size(), 100 * row.fit.best().within_half);
  bool same = true;
  if (!scan.surface.triangles.empty()) {
    const MeshTopology truth = topology_of(scan.surface.view());
    same = made == truth;
    const Spread to = distances(test::points_on(mesh, 1, 1), scan.surface);
    const Spread from = distances(test::points_on(scan.surface, 1, 2), mesh);
    fmt::print(" {:>7} {:6.3f} {:5.2f} {:6.3f} {:5.2f}", text_of(truth), to.rms, to.most, from.rms,
               from.most);
  }
  fmt::print(" {:5} {:4} {:5.1f} s{}\n", row.fit.joined, row.fit.left_out, row.seconds,
             same ? "" : " *");
  std::fflush(stdout);
  return same;
}

int run(int argc, char** argv) {
  CLI::App app("the reference surface of generated scans beside the surface that was scanned");
  Options options;
  app.add_option("--shape", options.shapes, "sphere torus box sheet slots");
  app.add_option("--density", options.densities, "even graded lines");
  app.add_option("--noise", options.noises, "standard deviations in multiples of epsilon");
  app.add_option("--kind", options.kinds, "plain holes outliers");
  app.add_option("--epsilon", options.epsilon, "the tolerance in multiples of the spacing");
  app.add_option("--scale", options.scale, "of the shapes; points stay as far apart");
  app.add_option("--seed", options.seed);
  app.add_option("--method", options.method);
  app.add_option("--out", options.out, "folder for clouds and references");
  app.add_option("--file", options.file, "this cloud in place of the generated ones");
  CLI11_PARSE(app, argc, argv);

  fmt::print(
      "topology: components/borders/genus; distances to and from the truth: RMS and 0.999 "
      "quantile\n{:32} {:>7} {:>9} {:5} {:>9} {:>6} {:>7} {:>12} {:>12} {:>5} {:>4}\n",
      "scan", "points", "topology", "by", "triangles", "e/2", "truth", "to", "from", "far", "left");
  if (!options.file.empty()) {
    test::ScanOfShape scan;
    scan.name = std::filesystem::path(options.file).filename();
    scan.points = read_cloud(options.file).points;
    print_row(scan, options);
    return 0;
  }
  std::size_t all = 0, same = 0;
  for (const std::string& kind : options.kinds) {
    for (const std::string& density : options.densities) {
      for (const double noise : options.noises) {
        for (const std::string& shape : options.shapes) {
          test::ScanSettings settings;
          settings.shape = shape;
          settings.density = density == "even"     ? test::Density::kEven
                             : density == "graded" ? test::Density::kGraded
                                                   : test::Density::kLines;
          settings.noise = noise * options.epsilon;
          settings.holes = kind == "holes";
          settings.outliers = kind == "outliers" ? 0.005 : 0;
          settings.scale = options.scale;
          settings.seed = options.seed;
          ++all;
          same += print_row(test::scan_of_shape(settings), options) ? 1 : 0;
        }
      }
    }
  }
  fmt::print("{} of {} have the truth's topology\n", same, all);
  return 0;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) { return emax::run(argc, argv); }
