// What the stages before a decimation take for a cloud of so many points; answers one JSON object.
// The cloud is a wavy sheet, with a hole or a far point for every hundred points.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "host/decimate/bounded_decimation.h"
#include "host/parameters/registry.h"
#include "host/reconstruct/local_cloud.h"
#include "host/surface/close_holes.h"
#include "tests/benchmarks/decimation/cpu_time.h"

namespace emax::benchmarks {
namespace {

constexpr std::uint32_t kEvery = 10;  // rows and columns: there is a hole or a far point
constexpr double kLift = 1.5;         // of a far point, in spacings

struct Sheet {
  std::uint32_t side;
  std::vector<Point> points;  // one apart, but for some jitter

  bool is_marked(std::uint32_t row, std::uint32_t column) const {
    return row % kEvery == kEvery / 2 && column % kEvery == kEvery / 2;
  }
};

Sheet sheet_of(double points) {
  Sheet sheet{static_cast<std::uint32_t>(std::lround(std::sqrt(points))), {}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  for (std::uint32_t row = 0; row < sheet.side; ++row) {
    for (std::uint32_t column = 0; column < sheet.side; ++column) {
      const double x = column + jitter(random), y = row + jitter(random);
      sheet.points.emplace_back(x, y, 3 * std::sin(x / 17) * std::cos(y / 23));
    }
  }
  return sheet;
}

TriangleMesh mesh_of(const Sheet& sheet, bool with_holes) {
  TriangleMesh mesh{sheet.points, {}};
  const auto add = [&](std::array<std::array<std::uint32_t, 2>, 3> corners) {
    Triangle t;
    for (std::size_t i = 0; i < 3; ++i) {
      if (with_holes && sheet.is_marked(corners[i][0], corners[i][1])) return;
      t[i] = corners[i][0] * sheet.side + corners[i][1];
    }
    mesh.triangles.push_back(t);
  };
  for (std::uint32_t row = 0; row + 1 < sheet.side; ++row) {
    for (std::uint32_t column = 0; column + 1 < sheet.side; ++column) {
      add({{{row, column}, {row, column + 1}, {row + 1, column + 1}}});
      add({{{row, column}, {row + 1, column + 1}, {row + 1, column}}});
    }
  }
  return mesh;
}

// How many times something was done. Each stage is timed without the making of its sheet.
std::size_t orient(const Sheet& sheet, CpuTime& time) {
  time = {};
  const Parameters parameters =
      parameters_of(Normals::kNeighbours, Normals::kOrientationNeighbours);
  const LocalCloud cloud(sheet.points);
  return cloud.oriented_normals(ParameterValues(parameters)).normals.size();
}

std::size_t close(const Sheet& sheet, CpuTime& time) {
  TriangleMesh mesh = mesh_of(sheet, true);
  time = {};
  return close_holes(std::move(mesh), 1e-2).closed;
}

std::size_t join(const Sheet& sheet, CpuTime& time) {
  const TriangleMesh mesh = mesh_of(sheet, false);
  std::vector<Point> cloud = sheet.points;
  for (std::uint32_t row = 0; row < sheet.side; ++row) {
    for (std::uint32_t column = 0; column < sheet.side; ++column) {
      if (sheet.is_marked(row, column)) cloud[row * sheet.side + column][2] += kLift;
    }
  }
  time = {};
  return reference_surface(mesh, cloud, 0.5).inserted;
}

const std::map<std::string, std::function<std::size_t(const Sheet&, CpuTime&)>> kStages = {
    {"normals", orient}, {"holes", close}, {"far", join}};

int run(int argc, const char* const* argv) {
  CLI::App app("What a stage takes for a wavy sheet of so many points");
  std::string stage;
  double points = 0;
  app.add_option("stage", stage)->required()->check(CLI::IsMember(kStages));
  app.add_option("points", points)->required()->check(CLI::Range(1e3, 1e9));
  CLI11_PARSE(app, argc, argv);
  const Sheet sheet = sheet_of(points);
  CpuTime time;
  const std::size_t done = kStages.at(stage)(sheet, time);
  const double seconds = time.seconds();
  if (done == 0) throw std::runtime_error("nothing was done");
  std::cout << nlohmann::ordered_json{{"points", sheet.points.size()},
                                      {"done", done},
                                      {"seconds", seconds}}
                   .dump()
            << "\n";
  return 0;
}

}  // namespace
}  // namespace emax::benchmarks

int main(int argc, char** argv) {
  try {
    return emax::benchmarks::run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "emax_growth_benchmark: {}\n", e.what());
    return 1;
  }
}
