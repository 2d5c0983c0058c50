// `emax error` as a person sees it: both directions, statistics, colours, JSON.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/geometry/cloud_file.h"
#include "host/geometry/mesh_file.h"
#include "sw_model/exact_distance.h"
#include "tests/host/app/program.h"
#include "tests/host/geometry/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;

class ErrorCommand : public testing::Test {
 protected:
  ErrorCommand() {
    test::write_scan(folder_.path() / "scan.xyz", 1500, 2);
    test::write_surface(folder_.path() / "surface.off", 10, 14);
    test::write_surface(folder_.path() / "fine.off", 40, 60);
  }

  ProgramRun error(std::vector<std::string> more) {
    more.insert(more.begin(), {"error", "scan.xyz", "surface.off"});
    return test::run_emax(more, folder_.path());
  }
  json errors(std::vector<std::string> more) {
    more.insert(more.end(), {"--json", "r.json"});
    const ProgramRun run = error(more);
    EXPECT_NE(run.exit_code, 1) << run.errors;
    return json::parse(test::file_text(folder_ / "r.json"));
  }
  // Distances by the oracle.
  std::vector<double> exact_distances() {
    const TriangleMesh mesh = read_mesh(folder_ / "surface.off");
    const ExactMesh exact(mesh.view());
    std::vector<double> distances;
    for (const Point& p : read_cloud(folder_ / "scan.xyz").points) {
      distances.push_back(exact.distance(p).upper);
    }
    return distances;
  }

  test::TemporaryFolder folder_;
};

TEST_F(ErrorCommand, StatisticsAreThoseOfTheExactDistances) {
  std::vector<double> distances = exact_distances();
  const json result = errors({"--quantile", "50", "--quantile", "99.9", "--worst", "3"});
  const json& found = result.at("errors").at("cloud_to_mesh");
  EXPECT_EQ(found.at("count"), 1500);
  EXPECT_EQ(found.at("maximum"), result.at("e_max"));
  double sum = 0, squares = 0;
  for (const double d : distances) {
    sum += d;
    squares += d * d;
  }
  EXPECT_NEAR(found.at("mean").get<double>(), sum / 1500, 1e-6);
  EXPECT_NEAR(found.at("rms").get<double>(), std::sqrt(squares / 1500), 1e-6);

  const json& worst = result.at("errors").at("worst_points");
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ(worst[0].at("point"), result.at("worst_point"));
  for (const json& far : worst) {
    EXPECT_EQ(far.at("distance").get<double>(), distances[far.at("point").get<std::size_t>()]);
  }
  std::ranges::sort(distances);
  EXPECT_EQ(worst[2].at("distance").get<double>(), distances[1497]);
  const json& quantiles = found.at("quantiles");
  ASSERT_EQ(quantiles.size(), 2u);
  EXPECT_NEAR(quantiles[0].at("distance").get<double>(), distances[749], 1e-6);
  EXPECT_NEAR(quantiles[1].at("distance").get<double>(), distances[1498], 1e-6);
  EXPECT_TRUE(found.at("exceeding").is_null());
  EXPECT_TRUE(result.at("errors").at("mesh_to_reference").is_null());
  EXPECT_EQ(result.at("bound"), "one-sided");
}

// The tolerance is a point's own distance, and then the next number below: where roundings decide.
TEST_F(ErrorCommand, CountsPointsBeyondATolerance) {
  std::vector<double> distances = exact_distances();
  std::ranges::sort(distances);
  for (const std::size_t rank : {1000u, 1499u}) {
    const double at = distances[rank];
    for (const double limit : {at, std::nextafter(at, 0)}) {
      const json result = errors({"--max-error", fmt::format("{}", limit)});
      const auto beyond = distances.end() - std::ranges::upper_bound(distances, limit);
      EXPECT_EQ(result.at("errors").at("cloud_to_mesh").at("exceeding"), beyond);
      EXPECT_EQ(result.at("feasible"), beyond == 0);
    }
  }
}

TEST_F(ErrorCommand, TwoSidedBoundsTheMeshToo) {
  const json surface = errors({"--two-sided", "--reference", "fine.off"});
  const json& back = surface.at("errors").at("mesh_to_reference");
  EXPECT_EQ(surface.at("bound"), "two-sided");
  EXPECT_EQ(back.at("kind"), "surface");
  const double lower = back.at("lower"), upper = back.at("upper");
  EXPECT_LE(lower, upper);
  EXPECT_LE(upper, lower * 1.002 + 1e-5);
  EXPECT_LE(back.at("samples").at("maximum").get<double>(), upper + 1e-6);
  EXPECT_GT(back.at("samples").at("maximum").get<double>(), upper / 2);
  const TriangleMesh fine = read_mesh(folder_ / "fine.off");
  const auto w = back.at("witness").get<std::array<double, 3>>();
  EXPECT_GE(ExactMesh(fine.view()).distance(Point(w[0], w[1], w[2])).upper, lower);

  const json cloud = errors({"--two-sided"});
  EXPECT_EQ(cloud.at("errors").at("mesh_to_reference").at("kind"), "cloud");
  EXPECT_EQ(cloud.at("errors").at("mesh_to_reference").at("reference"), "scan.xyz");
  // A cloud lies less densely than a surface.
  EXPECT_GT(cloud.at("errors").at("mesh_to_reference").at("lower").get<double>(), upper);

  // The other direction decides, too.
  const double forth = surface.at("e_max").get<double>();
  const double both = 1.001 * std::max(forth, upper);
  EXPECT_EQ(
      error({"--two-sided", "--reference", "fine.off", "--max-error", fmt::format("{}", both)})
          .exit_code,
      0);
  EXPECT_EQ(error({"--two-sided", "--max-error", fmt::format("{}", 1.001 * forth)}).exit_code, 2);
  EXPECT_EQ(error({"--max-error", fmt::format("{}", 1.001 * forth)}).exit_code, 0);
}

TEST_F(ErrorCommand, WritesColouredFiles) {
  const ProgramRun run = error(
      {"--two-sided", "--color", "cloud.ply", "--color-mesh", "mesh.ply", "--max-error", "5%"});
  EXPECT_NE(run.exit_code, 1) << run.errors;
  EXPECT_NE(run.output.find("viridis, dark blue 0"), std::string::npos) << run.output;
  EXPECT_EQ(read_cloud(folder_ / "cloud.ply").points, read_cloud(folder_ / "scan.xyz").points);
  const TriangleMesh mesh = read_mesh(folder_ / "mesh.ply"),
                     given = read_mesh(folder_ / "surface.off");
  EXPECT_EQ(mesh.vertices, given.vertices);
  EXPECT_EQ(mesh.triangles, given.triangles);
}

TEST_F(ErrorCommand, PrintsJsonAloneOnRequest) {
  const ProgramRun run = error({"--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.output, (errors({}), test::file_text(folder_ / "r.json")));
}

TEST_F(ErrorCommand, ShowsAPersonWhatThereIs) {
  const ProgramRun run = error({"--two-sided", "--reference", "fine.off", "--max-error", "1%"});
  EXPECT_EQ(run.exit_code, 2) << run.errors;
  for (const char* text :
       {"cloud to mesh, 1500 points", "maximum", "mean", "RMS", "50 %", "99.9 %", "exceeding",
        "histogram", "####", "worst points", "mesh to surface fine.off, ", "maximum at most"}) {
    EXPECT_NE(run.output.find(text), std::string::npos) << text << "\n" << run.output;
  }
}

TEST_F(ErrorCommand, RefusesInOneLineAndWritesNothing) {
  const auto before = test::files_in(folder_.path());
  const auto refused = [&](const std::vector<std::string>& more, const char* text) {
    const ProgramRun run = error(more);
    EXPECT_EQ(run.exit_code, 1) << text;
    EXPECT_NE(run.errors.find(text), std::string::npos) << run.errors;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    EXPECT_EQ(test::files_in(folder_.path()), before) << text;
  };
  refused({"--two-sided", "--reference", "absent.ply"}, "absent.ply");
  refused({"--reference", "fine.off"}, "--two-sided");
  refused({"--color", "cloud.obj"}, "cloud.obj");
  refused({"--two-sided", "--color", "a.ply", "--color-mesh", "a.ply"}, "a.ply");
  refused({"--quantile", "101"}, "101");
  refused({"--worst", "-1"}, "-1");
  refused({"--two-sided", "--reference", "scan.stl"}, "scan.stl");
}

}  // namespace
}  // namespace emax
