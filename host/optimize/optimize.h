#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "host/decimate/chain_parameters.h"
#include "host/genocop/genocop.h"
#include "host/geometry/mesh_file.h"
#include "host/optimize/config.h"
#include "host/optimize/error_constraint.h"

namespace emax {

// The search for the parameter set (P_R, P_D) whose mesh has the fewest triangles with
// e_max <= epsilon (paper, sections 3 and 3.1).
struct OptimizeSettings {
  std::string method = "gp3";
  std::string decimator = "schroeder";
  Config config;
  std::uint64_t seed = 1;
  std::optional<std::chrono::duration<double>> time;  // stop after this long
  unsigned jobs = 1;                                  // worker processes
  std::filesystem::path output;  // what this file will hold is what is measured
  std::function<bool()> interrupted = [] { return false; };
  // Called with every mesh whose error was measured.
  std::function<void(MeshView, const MeasuredError&)> measured = [](MeshView, const auto&) {};
};

// The best point so far, or at the end.
struct BestMesh {
  std::uint64_t index;  // of its evaluation
  TriangleMesh mesh;    // as stored
  MeasuredError error;
  ParameterValues parameters;
  std::size_t reconstruction_triangles;
  std::size_t unmeshed_points;
};

struct OptimizeState {
  std::uint64_t evaluations = 0;  // completed, failed and repeated ones included
  std::uint64_t budget = 0;
  std::map<std::string, std::uint64_t> failures;  // by reason
  std::string last_failure;
  std::optional<BestMesh> best;         // feasible
  std::optional<BestMesh> least_error;  // of the meshes that are not
  bool interrupted = false, out_of_time = false;
  std::string device_failure;  // that ended the run
};

// Called after every evaluation and at least every tenth of a second.
using OptimizeObserver = std::function<void(const OptimizeState&)>;

// Evaluations run in worker processes; e_max is measured here, on the device or, without one, on
// this processor. A run that ends by its budget gives the same state for any number of jobs and any
// device. Throws Error when workers cannot run, and where `output` would round more than epsilon
// allows.
OptimizeState optimize(std::span<const Point> cloud, ErrorConstraint& constraint, Evaluator* device,
                       const OptimizeSettings& settings, const OptimizeObserver& observe);

}  // namespace emax
