#include "real_problem.h"

#include <memory>
#include <sstream>

#include "host/files/cloud_file.h"
#include "host/geometry/bounds.h"
#include "host/optimize/optimize.h"
#include "host/optimize/run_bound.h"
#include "sw_model/base/error.h"

namespace emax::benchmark {
namespace {

struct RealSearch {
  RealSearch(const std::filesystem::path& file, double percent, const std::string& decimator,
             double excluded_share)
      : cloud(read_cloud(file).points) {
    const double epsilon = percent / 100 * bounds_of(cloud).width();
    constraint = std::make_unique<ErrorConstraint>(cloud, epsilon, excluded_share);
    settings.decimator = decimator;
    settings.config = default_config(chain_parameters(settings.method, decimator));
    settings.config.search.monotone_walk = false;  // every trial is an evaluation
    settings.output = "mesh.ply";
    if (decimator == "bounded") settings.epsilon_back = epsilon;
    settings.bound = decimation_bound(cloud, *constraint, settings);
    problem = search_problem(settings);
    pool = std::make_unique<WorkerPool>(cloud, settings.bound,
                                        worker_pool_options(cloud.size(), settings));
  }

  Evaluation evaluate(const Genes& genes) {
    pool->submit(0, chain_of(settings, problem, genes));
    const Completed completed = pool->wait();
    const auto* made = std::get_if<ChainResult>(&completed.outcome);
    if (made == nullptr) return {};
    try {
      const MeasuredError error = constraint->measure(made->mesh.view());
      return make_evaluation(problem.nonlinear, static_cast<double>(made->mesh.triangles.size()),
                             constraints_of(*made, error, settings.bound));
    } catch (const Error&) {  // a mesh that cannot be measured fails, as in a run
      return {};
    }
  }

  std::vector<Point> cloud;
  std::unique_ptr<ErrorConstraint> constraint;
  OptimizeSettings settings;
  Problem problem;
  std::unique_ptr<WorkerPool> pool;
};

}  // namespace

BenchmarkProblem real_problem(const std::string& name, const std::filesystem::path& data) {
  std::istringstream words(name);
  std::string scan, decimator;
  double percent = 0;
  words >> scan >> percent >> decimator;
  const bool building = scan == "building";
  if (!words || percent <= 0 || (scan != "bunny" && !building) ||
      (decimator != "schroeder" && decimator != "bounded")) {
    throw Error("no such problem: " + name + "; one is \"bunny 0.321 schroeder\"");
  }
  const auto search = std::make_shared<RealSearch>(
      data / (building ? "building.ply" : "bunny00.off"), percent, decimator, building ? 0.005 : 0);
  return {name, search->problem, [search](const Genes& genes) { return search->evaluate(genes); },
          0};
}

}  // namespace emax::benchmark
