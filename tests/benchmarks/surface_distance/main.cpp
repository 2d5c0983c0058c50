// The certified distance of one surface from another, timed; answers one JSON object. The meshes
// are also written as arrays, for a peer to measure the same ones.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "host/files/mesh_file.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/benchmarks/decimation/cpu_time.h"
#include "tests/benchmarks/decimation/raw_mesh.h"

namespace emax::benchmarks {
namespace {

struct Options {
  std::filesystem::path mesh, reference, arrays;
  double gap = 0, limit = -1;
};

nlohmann::ordered_json measure(const Options& options) {
  const TriangleMesh mesh = read_mesh(options.mesh), reference = read_mesh(options.reference);
  if (!options.arrays.empty()) {
    write_raw(options.arrays / "mesh", mesh);
    write_raw(options.arrays / "reference", reference);
  }
  SurfaceDistanceOptions settings;
  settings.relative = 0;
  settings.absolute = options.gap;
  settings.limit = options.limit;
  const CpuTime time;
  const ExactMesh exact(reference.view());
  const double prepared = time.seconds();
  const SurfaceDistance found = surface_distance(mesh.view(), exact, settings);
  return {{"lower", found.lower},
          {"upper", found.upper},
          {"seconds", time.seconds()},
          {"prepared", prepared},
          {"cuts", found.cuts},
          {"triangles", mesh.triangles.size()},
          {"reference_triangles", reference.triangles.size()}};
}

int run(int argc, const char* const* argv) {
  CLI::App app("The greatest distance of a mesh's surface from a reference's");
  Options options;
  app.add_option("mesh", options.mesh, "whose points are measured")->required();
  app.add_option("reference", options.reference, "from what")->required();
  app.add_option("--gap", options.gap, "the search ends when both ends are this near");
  app.add_option("--limit", options.limit, "only decide whether the distance is within it");
  app.add_option("--arrays", options.arrays, "a folder for the two meshes as arrays");
  CLI11_PARSE(app, argc, argv);
  std::cout << measure(options).dump() << "\n";
  return 0;
}

}  // namespace
}  // namespace emax::benchmarks

int main(int argc, char** argv) {
  try {
    return emax::benchmarks::run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "emax_surface_distance_benchmark: {}\n", e.what());
    return 1;
  }
}
