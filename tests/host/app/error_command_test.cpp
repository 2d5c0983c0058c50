// `emax error` as a person sees it: both directions, statistics, colours, JSON.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "sw_model/certify/exact_distance.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/app/program.h"
#include "tests/support/temporary_folder.h"

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
// Half a metre, whichever way it is given.
TEST_F(ErrorCommand, TolerancesHaveUnits) {
  const json metres = errors({"--max-error", "0.5", "--unit", "m"});
  EXPECT_EQ(metres.at("unit"), "m");
  EXPECT_EQ(errors({"--max-error", "500mm", "--unit", "m"}).at("epsilon"), metres.at("epsilon"));
  EXPECT_EQ(errors({"--max-error", "50cm", "--unit", "mm"}).at("epsilon"), 500);
  EXPECT_EQ(errors({"--loa", "40", "--unit", "mm"}).at("epsilon"), 5);
  EXPECT_EQ(errors({"--max-error", "0.5"}).at("unit"), nullptr);
  EXPECT_NE(error({"--loa", "30", "--unit", "m"}).output.find("LOA 30, as a maximum"),
            std::string::npos);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--max-error", "0.5mm"},
        {"--loa", "30"},
        {"--unit", "km"},
        {"--loa", "10", "--unit", "m"},
        {"--loa", "30", "--max-error", "1", "--unit", "m"}}) {
    const ProgramRun run = error(wrong);
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_NE(run.errors.find("--"), std::string::npos) << run.errors;
  }
}

TEST_F(ErrorCommand, WritesDeviationsIntoTheMesh) {
  for (const std::string name : {"deviations.ply", "deviations.glb"}) {
    const ProgramRun run = error({"--deviations", name});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.output.find(name + ": of each vertex"), std::string::npos) << run.output;
    EXPECT_FALSE(read_mesh_file(folder_ / name).attributes.empty()) << name;
  }
  EXPECT_EQ(error({"--deviations", "deviations.stl"}).exit_code, 1);
}

TEST_F(ErrorCommand, ADoubtfulUnitIsRemarked) {
  EXPECT_NE(error({"--unit", "um"}).output.find("say --unit m\n"), std::string::npos);
  EXPECT_EQ(error({"--unit", "mm"}).output.find("remark"), std::string::npos);
  EXPECT_EQ(error({}).output.find("remark"), std::string::npos);
}

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

  EXPECT_TRUE(cloud.at("errors").at("reference_to_mesh").is_null());
  EXPECT_TRUE(cloud.at("errors").at("reference_topology").is_null());
  const json closed = {{"components", 1}, {"border_loops", 0}, {"genus", 0}};
  EXPECT_EQ(surface.at("errors").at("reference_topology"), closed);
  EXPECT_EQ(surface.at("topology"), closed);

  // And from the reference to the mesh.
  const json& whole = surface.at("errors").at("reference_to_mesh");
  const TriangleMesh coarse = read_mesh(folder_ / "surface.off");
  const SurfaceDistance twin = surface_distance(fine.view(), ExactMesh(coarse.view()));
  EXPECT_LE(whole.at("lower").get<double>(), twin.upper);
  EXPECT_GE(whole.at("upper").get<double>(), twin.lower);
  EXPECT_LE(whole.at("samples").at("maximum").get<double>(),
            whole.at("upper").get<double>() + 1e-6);

  // The other directions decide, too.
  const double forth = surface.at("e_max").get<double>();
  const double both = 1.001 * std::max({forth, upper, whole.at("upper").get<double>()});
  EXPECT_EQ(
      error({"--two-sided", "--reference", "fine.off", "--max-error", fmt::format("{}", both)})
          .exit_code,
      0);
  EXPECT_EQ(error({"--two-sided", "--max-error", fmt::format("{}", 1.001 * forth)}).exit_code, 2);
  EXPECT_EQ(error({"--max-error", fmt::format("{}", 1.001 * forth)}).exit_code, 0);
}

// A cube, its points on edges and corners, and for each direction a fault that it alone catches.
TEST_F(ErrorCommand, EachDirectionCatchesTheFaultThatItAloneSees) {
  TriangleMesh cube;
  for (int v = 0; v < 8; ++v) cube.vertices.emplace_back(8 * (v & 1), 4 * (v & 2), 2 * (v & 4));
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  std::ofstream points(folder_ / "points.xyz");
  for (int v = 0; v < 8; ++v) {
    for (const int axis : {1, 2, 4}) {
      if ((v & axis) != 0) continue;
      for (int i = 0; i <= 4; ++i) {
        const Point p = cube.vertices[v] + 0.25 * i * (cube.vertices[v | axis] - cube.vertices[v]);
        points << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
      }
    }
  }
  points.close();
  std::ofstream(folder_ / "stray.xyz") << test::file_text(folder_ / "points.xyz") << "4 4 10\n";
  // The bottom becomes a frame of width 1 around a hole.
  TriangleMesh holed = cube;
  holed.triangles.erase(holed.triangles.begin(), holed.triangles.begin() + 2);
  const std::array<std::uint32_t, 4> ring = {0, 2, 3, 1};
  for (const std::uint32_t v : ring) {
    const Point& p = cube.vertices[v];
    holed.vertices.emplace_back(p.x() > 0 ? 7 : 1, p.y() > 0 ? 7 : 1, 0);
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    holed.triangles.push_back({ring[i], ring[j], 8 + j});
    holed.triangles.push_back({ring[i], 8 + j, 8 + i});
  }
  // A sheet through the inside.
  TriangleMesh sheet = cube;
  sheet.triangles.push_back({0, 3, 7});
  write_mesh(folder_ / "cube.off", cube);
  write_mesh(folder_ / "holed.off", holed);
  write_mesh(folder_ / "sheet.off", sheet);

  const auto judge = [&](const std::string& cloud, const std::string& mesh) {
    return test::run_emax({"error", cloud, mesh, "--two-sided", "--reference", "cube.off",
                           "--max-error", "1", "--json", "r.json"},
                          folder_.path());
  };
  const auto beyond = [&] {
    const json r = json::parse(test::file_text(folder_ / "r.json"));
    const json& errors = r.at("errors");
    return std::array<bool, 3>{r.at("e_max").get<double>() > 1,
                               errors.at("mesh_to_reference").at("lower").get<double>() > 1,
                               errors.at("reference_to_mesh").at("lower").get<double>() > 1};
  };
  using Beyond = std::array<bool, 3>;
  const struct {
    const char *cloud, *mesh, *said;
    Beyond beyond;
  } cases[] = {{"points.xyz", "cube.off", ": kept", {false, false, false}},
               {"stray.xyz",
                "cube.off",
                "exceeded: points are farther than that from the mesh",
                {true, false, false}},
               {"points.xyz",
                "sheet.off",
                "parts of the mesh are farther than that from the reference",
                {false, true, false}},
               {"points.xyz",
                "holed.off",
                "parts of the reference are farther than that from the mesh",
                {false, false, true}}};
  for (const auto& c : cases) {
    const ProgramRun run = judge(c.cloud, c.mesh);
    EXPECT_EQ(run.exit_code, c.beyond == Beyond{} ? 0 : 2) << c.said << run.errors;
    EXPECT_NE(run.output.find(c.said), std::string::npos) << run.output;
    EXPECT_EQ(beyond(), c.beyond) << c.said;
  }
  EXPECT_NE(judge("points.xyz", "holed.off")
                .output.find("topology       1 component, 1 border, genus 0; the reference: 1 "
                             "component, closed, genus 0"),
            std::string::npos);
  // Another cloud as a reference is measured in both directions.
  EXPECT_EQ(test::run_emax({"error", "points.xyz", "cube.off", "--two-sided", "--reference",
                            "stray.xyz", "--max-error", "9", "--json", "r.json"},
                           folder_.path())
                .exit_code,
            0);
  EXPECT_EQ(beyond(), (Beyond{false, true, true}));
}

// Without the line that tells the time.
std::string without_time(const std::string& output) {
  std::string kept;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("device ")) kept += line + '\n';
  }
  return kept;
}

class StreamedErrorCommand : public ErrorCommand {
 protected:
  StreamedErrorCommand() {
    test::write_scan(folder_.path() / "scan.xyz", 20000, 2);
    std::filesystem::create_directory(folder_ / "scans");
    test::write_scan(folder_ / "scans" / "a.xyz", 3000, 3);
    test::write_scan(folder_ / "scans" / "b.xyz", 4000, 4);
    std::ofstream(folder_ / "scans" / "a.xyz", std::ios::app) << "nan 0 0\n1 2 3\n";
  }

  // The output and the JSON are the same whether the cloud is in memory or not.
  void expect_same(const std::string& cloud, std::vector<std::string> more) {
    SCOPED_TRACE(cloud + ' ' + fmt::format("{}", fmt::join(more, " ")));
    more.insert(more.begin(), {"error", cloud, "surface.off", "--json"});
    const auto with = [&](const std::string& file, const std::string& memory) {
      auto words = more;
      words.insert(words.begin() + 4, file);
      if (!memory.empty()) words.insert(words.end(), {"--memory", memory});
      return test::run_emax(words, folder_.path());
    };
    const ProgramRun whole = with("whole.json", "");
    const ProgramRun pieces = with("pieces.json", "0");
    EXPECT_NE(whole.exit_code, 1) << whole.errors;
    EXPECT_EQ(pieces.exit_code, whole.exit_code) << pieces.errors;
    EXPECT_EQ(without_time(pieces.output), without_time(whole.output));
    EXPECT_EQ(test::file_text(folder_ / "pieces.json"), test::file_text(folder_ / "whole.json"));
  }
};

TEST_F(StreamedErrorCommand, GivesTheResultOfTheWhole) {
  expect_same("scan.xyz", {});
  expect_same("scan.xyz", {"--max-error", "1%", "--worst", "0", "--quantile", "33"});
  expect_same("scan.xyz", {"--max-error", "1%", "--exclude-outliers", "7%"});
  expect_same("scan.xyz", {"--exclude-outliers", "0.1%", "--worst", "3000"});
  expect_same("scan.xyz", {"--two-sided", "--reference", "fine.off", "--max-error", "5%"});
  expect_same("scans", {"--skip-invalid"});
  expect_same("scans", {"--skip-invalid", "--exclude-outliers", "1%"});
  test::write_scan(folder_.path() / "scan.xyz", 1500, 2);
  expect_same("scan.xyz", {"--brute-force"});
}

// A certificate is recomputed with the same answer, whatever does not hold of it.
TEST_F(StreamedErrorCommand, VerifiesAsTheWhole) {
  std::ofstream(folder_ / "scan.xyz", std::ios::app) << "3 0 0\n0 2 0\n";
  const ProgramRun made =
      test::run_emax({"decimate", "fine.off", "-o", "m.ply", "--cloud", "scan.xyz", "--max-error",
                      "8%", "--exclude-outliers", "0.2%"},
                     folder_.path());
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  const auto verify = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"verify", name});
    return test::run_emax(more, folder_.path());
  };
  json certificate = json::parse(test::file_text(folder_ / "m.ply.certificate.json"));
  EXPECT_GT(certificate.at("excluded").size(), 0u);
  const auto expect_same_answer = [&](const char* what, int exit_code) {
    SCOPED_TRACE(what);
    std::ofstream(folder_ / "c.json") << certificate.dump();
    const ProgramRun whole = verify("c.json", {});
    const ProgramRun pieces = verify("c.json", {"--memory", "0"});
    EXPECT_EQ(whole.exit_code, exit_code) << whole.output << whole.errors;
    EXPECT_EQ(pieces.exit_code, exit_code) << pieces.errors;
    EXPECT_EQ(pieces.output, whole.output);
  };
  expect_same_answer("as it was made", 0);
  const json whole = certificate;
  certificate.at("e_max") = certificate.at("e_max").get<double>() * 0.9;
  expect_same_answer("a smaller error", 2);
  certificate = whole;
  certificate.at("excluded").at(0).at("point") = 20002;
  expect_same_answer("a point that the cloud lacks", 2);
}

TEST_F(StreamedErrorCommand, NamesTheOptionsThatNeedAllPointsAtOnce) {
  const std::vector<std::vector<std::string>> needy = {
      {"--two-sided"},        {"--color", "c.ply"},   {"--deviations", "d.ply"},
      {"--report", "r.html"}, {"--picture", "p.png"}, {"--device", "sim"}};
  for (std::vector<std::string> more : needy) {
    const std::string option = more.front();
    more.insert(more.end(), {"--memory", "1MB"});
    const ProgramRun run = error(more);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find("20,000 points need 0.00128 GB, more than the 0.001"),
              std::string::npos)
        << run.errors;
    EXPECT_NE(run.errors.find(option), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("; give more memory, or leave it out"), std::string::npos);
  }
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
        "histogram", "####", "worst points", "mesh to surface fine.off, ",
        "surface fine.off, 4680 triangles to mesh", "maximum at most",
        "topology       1 component, closed, genus 0, like the reference"}) {
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
