#include "host/app/tiled_optimize.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>

#include "host/app/interrupt.h"
#include "host/app/reference_file.h"
#include "host/app/result_files.h"
#include "host/parameters/registry.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Clock = std::chrono::steady_clock;

// Of the tolerance, what the surface gives up for a fraction of its triangles
// (docs/decisions/0038-tiles-are-simplified.md).
constexpr double kSimplified = 0.125;
// Points: moving vertices, too, would take hours.
constexpr std::size_t kQuickBeyond = 3'000'000;

std::string surface_file(const OptimizeOptions& options) { return options.output + ".surface.ply"; }
std::string tile_folder(const OptimizeOptions& options) { return options.output + ".tiles"; }

void check(const OptimizeOptions& options) {
  const auto refuse = [](std::string_view option) {
    throw Error("--tiles cannot be combined with " + std::string(option) +
                ": a cloud in tiles gets one surface, by imls, and one decimation");
  };
  if (options.method != kFitMethod && options.method != Imls::kName) {
    refuse("--method " + options.method);
  }
  if (options.decimator != Bounded::kName) refuse("--decimator " + options.decimator);
  if (options.features != kNoFeatures) refuse("--features");
  if (options.common.device != "cpu") refuse("--device");
  if (options.max_error.empty() && options.level == 0) {
    throw Error("--tiles needs --max-error; `emax info` says which tolerance suits a scan");
  }
}

ReconstructOptions reconstruction(const OptimizeOptions& options) {
  ReconstructOptions made;
  made.cloud = options.common.cloud;
  made.output = surface_file(options);
  made.unit = options.common.unit;
  made.method = std::string(Imls::kName);
  made.tolerance = given_tolerance(options.max_error, options.level);
  made.thin = options.thin;
  if (!made.thin) {  // finer details are not asked for
    made.thin = made.tolerance;
    made.thin->value /= 2;
  }
  made.simplify = made.tolerance;
  made.simplify->value *= kSimplified;
  made.memory = options.memory;
  made.tile_points = kTilePoints;
  made.tile_folder = tile_folder(options);
  made.keep_tiles = true;  // until the mesh is there
  made.machines = options.machines;
  made.jobs = options.jobs;
  made.reading = options.common.reading;
  return made;
}

DecimateOptions decimation(const OptimizeOptions& options) {
  DecimateOptions made;
  made.mesh = surface_file(options);
  made.cloud = options.common.cloud;
  made.unit = options.common.unit;
  made.max_error = options.max_error;
  made.level = options.level;
  made.output = options.output;
  made.effort = options.effort;
  if (!options.effort_is_given) made.quick_beyond = kQuickBeyond;
  made.json = options.common.json;
  made.report = options.common.report;
  made.excluded_share = options.common.excluded_share;
  made.threads = options.jobs;
  made.memory = options.memory;
  made.tile_triangles = options.tile_triangles;
  made.tile_folder = tile_folder(options) + "/points";
  made.machines = options.machines;
  made.two_sided = options.bound != "one-sided";
  made.closed = options.closed;
  made.reading = options.common.reading;
  return made;
}

}  // namespace

int run_optimize_in_tiles(const OptimizeOptions& options) {
  const Clock::time_point begun = Clock::now();
  check(options);
  check_mesh_outputs(options.output, options.bound != "one-sided");
  const int reconstructed = run_reconstruct(reconstruction(options));
  if (reconstructed != kExitOk) return reconstructed;
  DecimateOptions decimate = decimation(options);
  if (options.seconds) {
    const std::chrono::duration<double> taken = Clock::now() - begun;
    decimate.seconds = std::max(1.0, *options.seconds - taken.count());
  }
  const int code = run_decimate(decimate);
  if (code == kExitInterrupted) return code;
  std::filesystem::remove_all(tile_folder(options));
  // The surface is the reference of the certificate unless points were joined to it.
  const bool is_reference = decimate.two_sided && !exists(reference_path(options.output));
  if (code != kExitOk || !is_reference) std::filesystem::remove(surface_file(options));
  return code;
}

}  // namespace emax
