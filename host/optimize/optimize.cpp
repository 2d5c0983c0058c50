#include "host/optimize/optimize.h"

#include <unistd.h>

#include <utility>

#include "host/genocop/look_ahead_scheduler.h"
#include "host/worker/worker_pool.h"
#include "sw_model/error.h"

namespace emax {
namespace {

constexpr std::chrono::milliseconds kHeartbeat{100};

class Run {
 public:
  Run(ErrorConstraint& constraint, Evaluator* device, const OptimizeSettings& settings,
      OptimizeState& state)
      : constraint_(constraint), device_(device), settings_(settings), state_(state) {
    search_.interrupted = settings.interrupted;
  }

  Evaluation evaluate(Completed completed, ParameterValues parameters) {
    if (const auto* failure = std::get_if<Failure>(&completed.outcome)) {
      fail(std::string(to_string(failure->reason)), failure->message);
      return {};
    }
    ChainResult& result = std::get<ChainResult>(completed.outcome);
    const MeshFormat format = mesh_format(settings_.output);
    require_storable(result.mesh, format, constraint_.epsilon(), settings_.output);
    try {
      TriangleMesh mesh = as_stored(result.mesh, format);
      MeasuredError error = device_ != nullptr
                                ? constraint_.measure(mesh.view(), *device_, search_)
                                : constraint_.measure(mesh.view(), settings_.interrupted);
      settings_.measured(mesh.view(), error);
      Evaluation evaluation = {true, static_cast<double>(mesh.triangles.size()), error.violation};
      offer({completed.ticket, std::move(mesh), std::move(error), std::move(parameters),
             result.reconstruction_triangles, result.unmeshed_points});
      return evaluation;
    } catch (const DeviceFailure& failure) {
      state_.device_failure = failure.what();
      return {};
    } catch (const Error& error) {
      fail("error", error.what());
      return {};
    }
  }

 private:
  void fail(const std::string& reason, const std::string& message) {
    ++state_.failures[reason];
    state_.last_failure = message;
  }

  // Completion order depends on the workers, so equals go to the lower index.
  void offer(BestMesh mesh) {
    std::optional<BestMesh>& place = mesh.error.feasible ? state_.best : state_.least_error;
    const auto key = [](const BestMesh& m) {
      return std::pair(m.error.feasible ? m.mesh.triangles.size() : m.error.kept.squared_bits,
                       m.index);
    };
    if (!place || key(mesh) < key(*place)) place = std::move(mesh);
  }

  ErrorConstraint& constraint_;
  Evaluator* device_;
  const OptimizeSettings& settings_;
  OptimizeState& state_;
  SearchOptions search_;
};

// The gene along which triangles fall and e_max rises, by decimator.
std::string_view monotone_gene(std::string_view decimator) {
  return decimator == "schroeder" ? "schroeder.reduction" : "";
}

// Of address space: one that outgrows its share of the memory fails, and not the machine.
std::uint64_t worker_memory(unsigned jobs) {
#if defined(__SANITIZE_ADDRESS__)
  return 0 * jobs;  // none: the sanitizer reserves terabytes that it never touches
#else
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) / jobs;
#endif
}

ParameterValues values_of(const Problem& problem, const Genes& genes) {
  ParameterValues values;
  for (std::size_t i = 0; i < genes.size(); ++i) values[problem.genes[i].name] = genes[i];
  return values;
}

}  // namespace

OptimizeState optimize(std::span<const Point> cloud, ErrorConstraint& constraint, Evaluator* device,
                       const OptimizeSettings& settings, const OptimizeObserver& observe) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const Problem problem = make_problem(settings.config, monotone_gene(settings.decimator));
  const Settings& search = settings.config.search;
  Genocop genocop(problem, search, settings.seed);
  LookAheadScheduler scheduler(genocop, search.budget);
  WorkerPoolOptions pool_options;
  pool_options.jobs = settings.jobs;
  pool_options.memory_limit = worker_memory(settings.jobs);
  WorkerPool pool(cloud, pool_options);

  OptimizeState state;
  state.budget = search.budget;
  Run run(constraint, device, settings, state);
  std::map<std::uint64_t, ParameterValues> in_work;
  while (!scheduler.finished()) {
    state.interrupted = settings.interrupted();
    state.out_of_time = settings.time && Clock::now() - start > *settings.time;
    // What is in work is given up: the pool's destructor ends its workers.
    if (state.interrupted || state.out_of_time) return state;
    // One more than the workers, so that none waits for the next candidate.
    while (pool.outstanding() <= settings.jobs) {
      const std::optional<Candidate> candidate = scheduler.next();
      if (!candidate) break;
      in_work[candidate->index] = values_of(problem, candidate->genes);
      pool.submit(candidate->index,
                  {settings.method, settings.decimator, in_work[candidate->index]});
    }
    if (pool.outstanding() > 0) {
      if (std::optional<Completed> completed = pool.wait_for(kHeartbeat)) {
        const std::uint64_t index = completed->ticket;
        auto parameters = in_work.extract(index);
        scheduler.complete(index,
                           run.evaluate(std::move(*completed), std::move(parameters.mapped())));
      }
    }
    state.evaluations = genocop.asked() - pool.outstanding();
    observe(state);
    if (!state.device_failure.empty()) return state;
  }
  return state;
}

}  // namespace emax
