#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/config/config.h"
#include "host/files/mesh_file.h"
#include "host/genocop/genocop.h"
#include "host/measure/error_constraint.h"
#include "host/optimize/evaluation_limits.h"
#include "host/parameters/chain_parameters.h"
#include "host/parameters/decimation_bound.h"
#include "host/parameters/registry.h"
#include "host/run_log/run_log.h"
#include "host/worker_pool/worker_pool.h"

namespace emax {

// The search for the parameter set (P_R, P_D) whose mesh has the fewest triangles with
// e_max <= epsilon (paper, sections 3 and 3.1).
struct OptimizeSettings {
  std::string method{Gp3::kName};
  // Of kFitMethod: the one that makes the reference; empty: one that fits the scan.
  std::string reference_method;
  std::string decimator{Bounded::kName};
  // Of a two-sided bound: how far a mesh may be from the reference.
  std::optional<double> epsilon_back;
  DecimationBound bound;  // of the bounded decimator: decimation_bound() of these settings
  // kNoFeatures, kOnPlanes, kAllFeatures or kAutoFeatures; all but the first need a decimator that
  // takes a bound.
  std::string features{kNoFeatures};
  // With features: what closes a hole on a plane of the scan may be so far from the surface. 0:
  // all holes stay open; nothing: epsilon.
  std::optional<double> hole_reach;
  bool closed = false;  // the reference of kFitMethod has its holes closed, close_surface()
  std::size_t reference_points = kReferencePoints;  // that kFitMethod first makes it of
  Config config;
  ParameterValues fitted;  // values to begin with where the configuration has the standard ones
  std::uint64_t seed = 1;
  // When the command began: the course's seconds count from here.
  std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
  unsigned jobs = 1;                       // worker processes
  std::optional<EvaluationLimits> limits;  // standard_limits unless given
  std::filesystem::path worker;            // empty: emax_worker beside the running program
  MakePool make_pool = make_worker_pool;   // where evaluations run
  RunLog* log = nullptr;                   // where results are kept and looked for
  // What else ends the search. Target and stagnation look at results in the order of their
  // candidates, so that the end does not depend on the number of jobs.
  std::function<double()> seconds_left = [] { return HUGE_VAL; };  // for all of it, the end too
  std::optional<std::uint64_t> target_triangles;  // a feasible mesh of at most so many
  std::optional<std::uint64_t> stagnation;        // so many evaluations without a better mesh
  // The best candidates of the bounded decimator are decimated once more in the end, deep and in
  // parallel, unless the run was interrupted, failed or has reached its target. Of limited time the
  // last part is for that.
  bool polish = true;
  std::filesystem::path output;  // what this file will hold is what is measured
  std::function<bool()> interrupted = [] { return false; };
  // Called with every mesh whose error was measured.
  std::function<void(MeshView, const MeasuredError&)> measured = [](MeshView, const auto&) {};
};

// The best point so far, or at the end.
struct BestMesh {
  std::uint64_t index;  // of its evaluation
  std::size_t triangles;
  double violation;            // of the constraints, at most 0 when feasible
  std::uint32_t squared_bits;  // the kernel's e_max^2 over the kept points
  ChainSettings chain;
  std::size_t reconstruction_triangles;
  std::size_t unmeshed_points;
  TriangleMesh mesh;  // as stored; it and its error may be missing before optimize returns
  MeasuredError error;
};

// A mesh that had fewer triangles than all before it.
struct FewerTriangles {
  double seconds;  // that the run's commands had taken by then
  std::size_t triangles;
  bool operator==(const FewerTriangles&) const = default;
};

struct OptimizeState {
  std::uint64_t evaluations = 0;  // completed, failed and repeated ones included
  std::uint64_t from_log = 0;     // of these, known before
  std::uint64_t stopped = 0;      // evaluations that were cut short, and gave the mesh at hand
  // Whose decimation ended early, because it would hardly have become the best.
  std::uint64_t outpaced = 0;
  std::uint64_t budget = 0;
  std::map<std::string, std::uint64_t> failures;  // by reason
  std::string last_failure;
  std::optional<BestMesh> best;         // feasible
  std::optional<BestMesh> least_error;  // the least violation of the meshes before that
  std::vector<FewerTriangles> course;   // of `best`; seconds never fall
  bool interrupted = false, out_of_time = false, target_reached = false, stagnated = false;
  bool polishing = false;               // has begun to
  double polish_seconds = 0;            // that this is expected to take
  std::optional<std::size_t> polished;  // has, without a failure; the triangles before that
  bool polish_stopped = false;          // for want of time
  std::string device_failure;           // that ended the run
  // What evaluations that were made took: their stages in the workers, e_max here.
  StageSeconds stages;
  double measuring = 0;
};

// Called after every evaluation and, while workers are waited for, every tenth of a second.
using OptimizeObserver = std::function<void(const OptimizeState&)>;

// The first record in a run's log that is one of the best candidates decimated deep.
inline constexpr std::uint64_t kPolishIndex = 1'000'000'000'000;

// How often, while workers are waited for, an observer is called and an interrupt looked for.
inline constexpr std::chrono::milliseconds kHeartbeat{100};

WorkerPoolOptions worker_pool_options(std::size_t points, const OptimizeSettings& settings);

// The next evaluation to complete. Throws Interrupted.
Completed wait_for_next(EvaluationPool& pool, const OptimizeSettings& settings);

// The gene of Schroeder's reduction, where every evaluation looks for its best value itself: it is
// fixed in the problem that is searched.
std::optional<std::size_t> walked_gene(const OptimizeSettings& settings);

// What is searched, once the bound of the settings is known.
Problem search_problem(const OptimizeSettings& settings);

// The candidate that genes of that problem are.
ChainSettings chain_of(const OptimizeSettings& settings, const Problem& problem,
                       const Genes& genes);

// The values of the problem's nonlinear constraints, each at most 0 when it holds. Of a bound: by
// what share it is broken. First e_max; under a two-sided bound then the distance of the mesh from
// the reference, that of the reference from the mesh, and the topology: the share that its
// difference from the reference's has of one more than itself.
std::vector<double> constraints_of(const ChainResult& made, const MeasuredError& error,
                                   const DecimationBound& bound);

// Evaluations run in worker processes; e_max is measured here, on the device or, without one, on
// this processor. A run that ends by its budget, target or stagnation gives the same state for any
// number of jobs and any device, and so does one that continues from its log, however often it was
// cut short: candidates are asked for again, and what the log knows is not evaluated again. Out of
// time or interrupted, it takes the meshes at hand of what is in work, whose evaluations a
// continued run makes again. Of best
// and least_error, the one that is to be shown has its mesh in the end. Throws Error when workers
// cannot run, where `output` would round more than epsilon allows, and when the log cannot be
// written or belongs to another search.
OptimizeState optimize(std::span<const Point> cloud, ErrorConstraint& constraint, Evaluator* device,
                       const OptimizeSettings& settings, const OptimizeObserver& observe);

}  // namespace emax
