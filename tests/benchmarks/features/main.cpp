// A tool that finds planes in a cloud, its time and what it found beside what is there, or how far
// the edges of a mesh are from the true ones, as JSON.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <exception>
#include <nlohmann/json.hpp>

#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/geometry/bounds.h"
#include "testbench/stimuli/random.h"
#include "tests/benchmarks/features/edge_distance.h"
#include "tests/benchmarks/features/plane_truth.h"

namespace emax::benchmarks {
namespace {

using nlohmann::json;

// Anywhere in the cloud's box.
void add_outliers(std::vector<Point>& cloud, double share, std::uint64_t seed) {
  Random random(seed);
  const Bounds box = bounds_of(cloud);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(cloud.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const Point p = random.point(0, 1);
    cloud.emplace_back(box.lower + p.cwiseProduct(box.upper - box.lower));
  }
}

std::vector<FoundPlane> planes_of(const std::string& tool, const PlaneTask& task) {
  if (tool == "emax-hough") return planes_of_emax(task, true);
  if (tool == "cgal-ransac") return planes_of_cgal_ransac(task);
  if (tool == "cgal-growing") return planes_of_cgal_growing(task);
  if (tool == "pcl-ransac") return planes_of_pcl_ransac(task);
  return planes_of_emax(task, false);
}

struct Words {
  std::string tool, cloud, truth, mesh;
  double band = 0, outliers = 0, flatness = 1e-5;
  std::size_t least_support = 500, least_known = 1000;
  std::uint64_t seed = 1;
};

json measured(const Words& words) {
  std::vector<Point> cloud = read_cloud(words.cloud).points;
  add_outliers(cloud, words.outliers, words.seed);
  const std::clock_t begun = std::clock();
  const std::vector<FoundPlane> planes =
      planes_of(words.tool, {cloud, words.band, words.least_support, words.seed});
  const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  std::size_t points = 0;
  double squares = 0;
  for (const FoundPlane& plane : planes) {
    points += plane.points.size();
    for (const std::uint32_t i : plane.points) {
      squares += std::pow(plane.plane.signed_distance(cloud[i]), 2);
    }
  }
  json told = {{"tool", words.tool},
               {"points", cloud.size()},
               {"band", words.band},
               {"seconds", seconds},
               {"planes", planes.size()},
               {"points_of_planes", points},
               {"rms", std::sqrt(squares / static_cast<double>(std::max<std::size_t>(points, 1)))}};
  if (words.truth.empty()) return told;
  const PlaneTruth truth = truth_of(read_mesh(words.truth), cloud, words.band, words.flatness);
  const PlaneScore score = score_of(truth, cloud, planes, words.least_known);
  told["known"] = score.known;
  told["found"] = score.found;
  told["wrong"] = score.wrong;
  told["angle"] = {{"greatest", score.greatest_angle}, {"mean", score.mean_angle}};
  told["offset"] = {{"greatest", score.greatest_offset}, {"mean", score.mean_offset}};
  return told;
}

// With planes in half of the band, as decimation finds them.
EdgeDistance edges_of(const Words& words) {
  const TriangleMesh mesh = read_mesh(words.mesh), truth = read_mesh(words.truth);
  const std::vector<Point> cloud = read_cloud(words.cloud).points;
  if (words.tool == "edges") return distance_of_edges(truth, mesh, cloud, words.band);
  const std::vector<FoundPlane> planes =
      planes_of_emax({cloud, words.band / 2, words.least_support, words.seed}, false);
  return distance_of_meeting_planes(planes, cloud, truth, mesh, words.band);
}

json edges(const Words& words) {
  const EdgeDistance found = edges_of(words);
  return {{"band", words.band},
          {"samples", found.samples},
          {"mean", found.mean},
          {"p95", found.p95},
          {"within_half", found.within_half}};
}

}  // namespace
}  // namespace emax::benchmarks

int main(int argc, char** argv) {
  CLI::App app("Finds the planes of a cloud with a tool, and tells how well, as JSON.");
  emax::benchmarks::Words words;
  app.add_option("TOOL", words.tool)
      ->required()
      ->check(CLI::IsMember(
          {"emax", "emax-hough", "cgal-ransac", "cgal-growing", "pcl-ransac", "edges", "meeting"}));
  app.add_option("CLOUD", words.cloud)->required();
  app.add_option("--max-error", words.band, "in the unit of the cloud")->required();
  app.add_option("--truth", words.truth, "the surface of which the cloud is a scan");
  app.add_option("--flatness", words.flatness,
                 "how far corners of the truth may be from their plane, in widths")
      ->capture_default_str();
  app.add_option("--mesh", words.mesh,
                 "of which `edges` measures how far those of the truth are, and `meeting` how far "
                 "the lines where planes of the cloud meet are, with a reference as the truth");
  app.add_option("--outliers", words.outliers, "to be added, as a share of the points");
  app.add_option("--least-points", words.least_support, "of a plane that a tool reports");
  app.add_option("--least-known", words.least_known, "of a plane that is to be found");
  app.add_option("--seed", words.seed);
  CLI11_PARSE(app, argc, argv);
  try {
    fmt::print("{}\n", (words.tool == "edges" || words.tool == "meeting"
                            ? emax::benchmarks::edges(words)
                            : emax::benchmarks::measured(words))
                           .dump());
  } catch (const std::exception& error) {
    fmt::print(stderr, "emax_features_benchmark: {}\n", error.what());
    return 1;
  }
  return 0;
}
