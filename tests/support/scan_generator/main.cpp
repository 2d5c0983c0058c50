// emax_scan: makes the scan of a scene whose surface is known.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include "host/files/mesh_file.h"
#include "sw_model/base/parallel.h"
#include "tests/support/scan_generator/scan_writer.h"
#include "tests/support/scan_generator/scanner.h"

namespace emax::test {
namespace {

Scene scene_of(const std::string& name, const std::string& mesh) {
  if (name == "hall") return hall();
  if (name == "terrain") return terrain();
  return statue(read_mesh(mesh));
}

// The program's own output, a pipe or a device: it is written from front to back.
bool is_stream(const std::string& output) {
  namespace fs = std::filesystem;
  return output == "-" || output == "/dev/stdout" ||
         (fs::exists(output) && !fs::is_regular_file(output));
}

void write_stream(const std::string& output, const std::string& format, const Scanner& scanner,
                  const PointSource& points) {
  std::ofstream file;
  const bool is_own = output == "-" || output == "/dev/stdout";
  if (!is_own) file.open(output, std::ios::binary);
  std::ostream& to = is_own ? std::cout : file;
  if (format == "las") {
    write_las_scan(to, points);
  } else {
    write_ply_scan(to, scanner.scan([](std::span<const Point>) {}), points);
  }
}

void write_file(const std::string& output, const PointSource& points) {
  if (output.ends_with(".las")) {
    write_las_scan(std::filesystem::path(output), points);
  } else if (output.ends_with(".e57")) {
    write_e57_scan(output, points);
  } else if (output.ends_with(".ply")) {
    write_ply_scan(std::filesystem::path(output), points);
  } else {
    throw std::runtime_error(output + ": the ending is not .las, .e57 or .ply");
  }
}

void run(const std::string& name, const std::string& mesh, const ScannerOptions& options,
         const std::string& output, const std::string& format, const std::string& truth) {
  const Scene scene = scene_of(name, mesh);
  if (!truth.empty()) write_mesh(truth, scene.mesh);
  const Scanner scanner(scene, options);
  const PointSource points = [&](const auto& take) { scanner.scan(take); };
  if (is_stream(output)) {
    write_stream(output, format, scanner, points);
  } else {
    write_file(output, points);
  }
  fmt::print(stderr, "{}, seed {}\n", output, options.seed);
}

}  // namespace
}  // namespace emax::test

int main(int argc, char** argv) {
  CLI::App app("Makes the scan of a scene whose surface is known, as a terrestrial scanner would.");
  std::string scene, mesh, output, truth, format = "las";
  emax::test::ScannerOptions options;
  options.threads = emax::processor_threads();
  app.add_option("SCENE", scene, "hall, terrain or statue")
      ->required()
      ->check(CLI::IsMember({"hall", "terrain", "statue"}));
  app.add_option("--mesh", mesh, "the mesh of the statue")->check(CLI::ExistingFile);
  app.add_option("--points", options.points, "about how many points")
      ->check(CLI::Range(1e2, 4e9))
      ->capture_default_str();
  app.add_option("--noise", options.noise, "of the range at 10 m, in metres")
      ->check(CLI::Range(0.0, 1e3))
      ->capture_default_str();
  app.add_option("--beam", options.beam,
                 "width of the beam in radians: at an edge it meets both sides")
      ->check(CLI::Range(0.0, 0.1))
      ->capture_default_str();
  app.add_option("--dropouts", options.dropouts, "share of the rays that do not come back")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("-o,--output", output, "the scan: .las, .e57, .ply, or - for a stream")
      ->required();
  app.add_option("--format", format, "of a stream")
      ->check(CLI::IsMember({"las", "ply"}))
      ->capture_default_str();
  app.add_option("--truth", truth, "also write the surface: a mesh");
  try {
    app.parse(argc, argv);
    if ((scene == "statue") == mesh.empty()) throw CLI::ValidationError("--mesh goes with statue");
    emax::test::run(scene, mesh, options, output, format, truth);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "emax_scan: {}\n", error.what());
    return 1;
  }
  return 0;
}
