// Measures one decimator on one scan and prints a line of JSON; `./dev bench --decimate` runs it.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "host/decimate/certified_decimation.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "tests/benchmarks/bisection/bisection.h"
#include "tests/benchmarks/decimation/cpu_time.h"
#include "tests/benchmarks/decimation/external_tool.h"
#include "tests/benchmarks/decimation/measures.h"
#include "tests/benchmarks/decimation/raw_mesh.h"
#include "tests/benchmarks/decimation/scans.h"
#include "tests/benchmarks/decimation/tool.h"

namespace emax::benchmarks {
namespace {

using nlohmann::json;
using Effort = DecimationSettings::Effort;

constexpr double kFewestTriangles = 40;
// By which triangle counts of a bisection's ends may differ.
constexpr double kShare = 0.004;
// Of the best so far: where another set of options begins, and below which it must come.
constexpr double kNext = 0.99, kBetter = 0.985;

struct Options {
  CaseFolders folders{"data", "build/bench/cases"};
  std::string scan, tool, command, start_folder;
  double percent = 0;
  std::size_t points = 0;
  bool quick = false;
};

constexpr double kFeatureAngle = 40;  // as in the README's advice for machine parts

struct OwnWay {
  const char *key, *name;
  bool two_sided;
  Effort effort;
  double feature_angle = 0;
};

constexpr OwnWay kOwnWays[] = {
    {"emax-two-sided", "emax, two-sided", true, Effort::kRelax},
    {"emax-two-sided-deep", "emax, two-sided, deep", true, Effort::kDeep},
    {"emax-two-sided-features", "emax, two-sided, features", true, Effort::kRelax, kFeatureAngle},
    {"emax-two-sided-quick", "emax, two-sided, quick", true, Effort::kCollapse},
    {"emax-one-sided", "emax, one-sided", false, Effort::kRelax},
    {"emax-one-sided-deep", "emax, one-sided, deep", false, Effort::kDeep},
    {"emax-one-sided-quick", "emax, one-sided, quick", false, Effort::kCollapse},
};

std::vector<Tool> tools() {
  return {openmesh_tool(),      vtk_quadric_tool(),         vtk_decimate_pro_tool(),
          meshoptimizer_tool(), cgal_lindstrom_turk_tool(), cgal_garland_heckbert_tool(),
          cgal_envelope_tool()};
}

TriangleMesh decimated(const DecimationScan& scan, const OwnWay& way) {
  CertifiedDecimationSettings settings;
  settings.decimation.epsilon = scan.epsilon;
  settings.decimation.two_sided = way.two_sided;
  settings.decimation.effort = way.effort;
  settings.decimation.feature_angle = way.feature_angle;
  return decimate_certified(scan.start, scan.cloud, settings).mesh;
}

// What a call gave; a mesh without triangles where the tool failed.
Trial timed(const std::function<TriangleMesh()>& call) {
  Trial trial;
  const CpuTime time;
  try {
    trial.mesh = call();
  } catch (const std::exception& error) {
    trial.mesh = {};
    trial.failure = error.what();
  }
  trial.seconds = time.seconds();
  return trial;
}

struct Range {
  double finest, coarsest;

  // Steps of a scan: factors of about 4.
  int steps() const {
    return static_cast<int>(std::ceil(std::abs(std::log(finest / coarsest)) / 1.4));
  }
};

Range range_of(const OptionSet& set, const DecimationScan& scan) {
  const auto triangles = static_cast<double>(scan.start.triangles.size());
  return set.parameter == OptionSet::Parameter::kTriangles
             ? Range{triangles, std::min(triangles / 4, kFewestTriangles)}
             : Range{set.finest, set.coarsest};
}

json searched(const DecimationScan& scan, const Tool& tool, bool quick) {
  CloudError error(scan.cloud);
  std::vector<OptionSet> sets = tool.option_sets(scan.start, scan.epsilon);
  if (quick) sets.resize(1);
  std::optional<Found> best;
  const OptionSet* best_set = nullptr;
  int calls = 0, failed_calls = 0;
  std::string failure;
  double seconds = 0, least_error = std::numeric_limits<double>::infinity();
  for (const OptionSet& set : sets) {
    const Range range = range_of(set, scan);
    BisectionSettings settings;
    settings.limit = scan.epsilon;
    settings.steps = range.steps();
    settings.width = 1e-4;
    settings.share = kShare;
    if (best) {
      const auto triangles = static_cast<double>(best->best->mesh.triangles.size());
      settings.beat = static_cast<std::size_t>(kBetter * triangles);
      if (set.parameter == OptionSet::Parameter::kTriangles) {
        settings.start = coarseness_at(kNext * triangles, range.finest, range.coarsest);
      } else if (best_set->parameter == set.parameter) {
        settings.start = best->coarseness;
      }
    }
    const Attempt attempt = [&](double coarseness) {
      Trial trial = timed(
          [&] { return set.simplify(parameter_at(coarseness, range.finest, range.coarsest)); });
      if (set.seconds) trial.seconds = set.seconds();
      if (!trial.failure.empty()) {
        ++failed_calls;
        failure = trial.failure;
      }
      trial.error = error(trial.mesh);
      return trial;
    };
    Found found = fewest_within(attempt, settings);
    calls += found.calls;
    seconds += found.seconds;
    least_error = std::min(least_error, found.least_error);
    if (found.best &&
        (!best || found.best->mesh.triangles.size() < best->best->mesh.triangles.size())) {
      best = std::move(found);
      best_set = &set;
    }
  }
  json result = {{"calls", calls}, {"all_seconds", seconds}};
  if (failed_calls > 0) {
    result["failed_calls"] = failed_calls;
    result["reason"] = failure;
  }
  if (!best) {
    result["least_error"] =
        std::isfinite(least_error) ? json(100 * least_error / scan.width) : json();
    return result;
  }
  result.update(measures(tool.name, scan, error, best->best->mesh));
  result["options"] = best_set->name;
  if (best_set->parameter == OptionSet::Parameter::kTolerance) {
    const Range range = range_of(*best_set, scan);
    result["tolerance"] = parameter_at(best->coarseness, range.finest, range.coarsest);
  }
  result["seconds"] = best->best->seconds;
  result["search_seconds"] = best->seconds;
  result["search_calls"] = best->calls;
  return result;
}

json own_result(const DecimationScan& scan, const OwnWay& way) {
  const Trial trial = timed([&] { return decimated(scan, way); });
  CloudError error(scan.cloud);
  json result = measures(way.name, scan, error, trial.mesh);
  result["seconds"] = result["search_seconds"] = result["all_seconds"] = trial.seconds;
  result["calls"] = result["search_calls"] = 1;
  return result;
}

// What keeping and certifying every point of the reference within epsilon takes: whole calls beside
// the same without that direction, in turn.
json third_direction(const DecimationScan& scan) {
  constexpr int kRounds = 5;
  DecimationSettings two;
  two.epsilon = scan.epsilon;
  std::vector<double> whole, without, shares;
  std::size_t triangles = 0;
  for (int round = 0; round < kRounds; ++round) {
    whole.push_back(timed([&] { return decimated(scan, kOwnWays[0]); }).seconds);
    const CpuTime time;
    const DeliberateFault two_directions(Fault::kSkipsReference);
    const ExactMesh reference(scan.start.view());
    const TriangleMesh mesh = BoundedDecimator(scan.start, scan.cloud).run(two).mesh;
    if (check_mesh(scan.start.view()).valid() != check_mesh(mesh.view()).valid() ||
        !certify(scan.cloud, mesh.view(), {}).within(scan.epsilon) ||
        !decided_distance(mesh.view(), reference, scan.epsilon).within(scan.epsilon)) {
      throw std::logic_error("two directions are not kept");
    }
    without.push_back(time.seconds());
    shares.push_back(whole.back() / without.back() - 1);
    triangles = mesh.triangles.size();
  }
  const auto spread = [](std::vector<double> values) {
    std::ranges::sort(values);
    return json{values[values.size() / 2], values.front(), values.back()};
  };
  return {{"seconds", spread(whole)},
          {"without", spread(without)},
          {"share", spread(shares)},
          {"triangles_without", triangles}};
}

// The time of one call; a tool that goes to a number goes to 2000 triangles.
double call_seconds(const DecimationScan& scan, const Tool& tool) {
  constexpr double kTriangles = 2000;
  const OptionSet set = tool.option_sets(scan.start, scan.epsilon).front();
  const bool to_number = set.parameter == OptionSet::Parameter::kTriangles;
  const double seconds = timed([&] { return set.simplify(to_number ? kTriangles : 1); }).seconds;
  return set.seconds ? set.seconds() : seconds;
}

json peer_result(const DecimationScan& scan, const Tool& tool, const Options& options) {
  json result = {{"name", tool.name}, {"version", tool.version}};
  if (options.points > 0) {
    result["seconds"] = call_seconds(scan, tool);
  } else {
    result.update(searched(scan, tool, options.quick));
  }
  return result;
}

json external_result(const DecimationScan& scan, const Options& options) {
  std::optional<Tool> tool;
  try {
    tool = external_tool(options.command);
  } catch (const std::exception& error) {
    return {{"failure", std::string("cannot: ") + error.what()}};
  }
  return peer_result(scan, *tool, options);
}

json measured(const Options& options) {
  const DecimationScan scan = options.points > 0
                                  ? smooth_torus(options.points, options.percent)
                                  : decimation_scan(options.folders, options.scan, options.percent);
  json result = {{"scan", options.scan},
                 {"percent", options.percent},
                 {"tool", options.tool},
                 {"points", scan.cloud.size() + scan.left_out},
                 {"left_out", scan.left_out},
                 {"start", scan.start.triangles.size()},
                 {"start_seconds", scan.start_seconds},
                 {"epsilon", scan.epsilon},
                 {"text", scan.text}};
  if (!options.start_folder.empty()) {
    write_raw(options.start_folder, scan.start);
    return result;
  }
  if (!options.command.empty()) {
    result.update(external_result(scan, options));
    return result;
  }
  if (options.tool == "third-direction") {
    result.update(third_direction(scan));
    return result;
  }
  for (const OwnWay& way : kOwnWays) {
    if (options.tool != way.key) continue;
    result["name"] = way.name;
    if (options.points > 0) {
      const Trial trial = timed([&] { return decimated(scan, way); });
      result["seconds"] = trial.seconds;
      result["triangles"] = trial.mesh.triangles.size();
    } else {
      result.update(own_result(scan, way));
    }
    return result;
  }
  for (const Tool& tool : tools()) {
    if (options.tool != tool.key) continue;
    result.update(peer_result(scan, tool, options));
    return result;
  }
  throw CLI::ValidationError("--tool", "there is no such tool: " + options.tool);
}

int main(int argc, char** argv) {
  Options options;
  CLI::App app("One decimator on one scan; `./dev bench --decimate` runs it",
               "emax_decimation_benchmark");
  app.add_option("--data", options.folders.data, "folder of the scans")->capture_default_str();
  app.add_option("--cache", options.folders.cache, "folder of meshes made once")
      ->capture_default_str();
  app.add_option(
      "--scan", options.scan,
      "bunny, dragon, fandisk, building, torus, smooth-torus, sphere, ellipsoid or a file "
      "of the folder meshes/");
  app.add_option("--points", options.points, "time alone, on a torus of about so many points");
  app.add_option("--percent", options.percent, "epsilon in percent of the width")
      ->required()
      ->check(CLI::PositiveNumber);
  CLI::Option* tool = app.add_option("--tool", options.tool, "the decimator");
  app.add_option("--command", options.command, "starts a decimator in a process of its own")
      ->excludes(tool);
  app.add_option("--write-start", options.start_folder,
                 "write what every decimator starts from into this folder, and end");
  app.add_flag("--quick", options.quick, "only the first set of options");
  try {
    app.parse(argc, argv);
    std::cout << measured(options).dump() << std::endl;
  } catch (const CLI::Error& error) {
    return app.exit(error);
  }
  return 0;
}

}  // namespace
}  // namespace emax::benchmarks

int main(int argc, char** argv) {
  try {
    return emax::benchmarks::main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "emax_decimation_benchmark: " << error.what() << '\n';
    return 1;
  }
}
