#include <algorithm>
#include <array>

#include "host/optimize/optimize.h"
#include "host/parameters/descriptions.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// The first start with other values where the problem has these genes, each within its domain.
// Nothing where it has none of them.
void add_start(Problem& problem, const ParameterValues& values) {
  Genes start = problem.starts.front();
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Gene& gene = problem.genes[i];
    const auto value = values.by_name().find(gene.name);
    if (value != values.by_name().end())
      start[i] = std::clamp(value->second, gene.lower, gene.upper);
  }
  if (std::ranges::count(problem.starts, start) == 0) problem.starts.push_back(std::move(start));
}

// What fits the scan goes before the standard values, but not before a person's own.
void begin_with_fitted(Problem& problem, const OptimizeSettings& settings) {
  ParameterValues values = settings.fitted;
  // Linear constraints could forbid it.
  if (values.by_name().empty() || !problem.linear.empty()) return;
  for (const Parameter& own : chain_parameters(settings.method, settings.decimator)) {
    const auto gene = std::ranges::find(settings.config.genes, own.name, &Parameter::name);
    const bool chosen = gene != settings.config.genes.end() && gene->standard != own.standard;
    if (chosen) values.by_name().erase(own.name);
  }
  const std::size_t before = problem.starts.size();
  add_start(problem, values);
  std::vector<std::vector<double>>& starts = problem.starts;
  if (starts.size() > before) std::rotate(starts.begin(), starts.end() - 1, starts.end());
}

// The second candidate is the first one without planes, whatever else the search begins with.
void begin_without_planes_too(Problem& problem) {
  const auto gene = std::ranges::find(problem.genes, PlaneFeatures::kMethod.name, &Gene::name);
  // Linear constraints could forbid it.
  if (gene == problem.genes.end() || !(gene->lower < gene->upper) || !problem.linear.empty()) {
    return;
  }
  Genes start = problem.starts.front();
  double& method = start[static_cast<std::size_t>(gene - problem.genes.begin())];
  method = gene->lower + gene->upper - method;  // the other one
  std::erase(problem.starts, start);
  problem.starts.insert(problem.starts.begin() + 1, std::move(start));
}

// Greedy projection leaves points out where its neighbourhoods are small for the cloud, and no
// decimation can come below the distance of such a point. So it also begins where few are left out.
void add_generous_starts(Problem& problem) {
  const bool greedy = std::ranges::any_of(
      problem.genes, [](const Gene& gene) { return gene.name == Gp3::kRadius.name; });
  // Linear constraints could forbid them.
  if (!greedy || !problem.linear.empty()) return;
  struct Generous {
    double radius, mu;
    int max_neighbors;
    double surface_angle, min_angle, max_angle;
    int normals;
  };
  constexpr std::array<Generous, 8> kGenerous = {{
      {3, 5, 200, 60, 5, 120, 40},
      {10, 5, 200, 60, 5, 120, 40},
      {14, 4, 300, 110, 0, 170, 20},
      {14, 6, 300, 60, 5, 120, 40},
      {14, 6, 300, 180, 0, 175, 20},
      {14, 6, 300, 150, 2, 165, 40},
      {14, 3, 300, 90, 0, 170, 30},
      {12, 4, 200, 130, 0, 160, 12},
  }};
  for (const Generous& g : kGenerous) {
    ParameterValues values;
    values.set(Gp3::kRadius, g.radius);
    values.set(Gp3::kMu, g.mu);
    values.set(Gp3::kMaxNeighbors, g.max_neighbors);
    values.set(Gp3::kSurfaceAngle, g.surface_angle);
    values.set(Gp3::kMinAngle, g.min_angle);
    values.set(Gp3::kMaxAngle, g.max_angle);
    values.set(Normals::kNeighbours, g.normals);
    add_start(problem, values);
  }
}

}  // namespace

WorkerPoolOptions worker_pool_options(std::size_t points, const OptimizeSettings& settings) {
  const EvaluationLimits limits = settings.limits.value_or(standard_limits(points));
  WorkerPoolOptions options;
  options.jobs = settings.jobs;
  options.time_limit = limits.time;
  options.memory_limit = limits.memory;
  options.program = settings.worker;
  return options;
}

Completed wait_for_next(EvaluationPool& pool, const OptimizeSettings& settings) {
  while (true) {
    if (settings.interrupted()) throw Interrupted{};
    if (auto completed = pool.wait_for(kHeartbeat)) return std::move(*completed);
  }
}

std::optional<std::size_t> walked_gene(const OptimizeSettings& settings) {
  const Parameters& genes = settings.config.genes;
  const auto gene = std::ranges::find_if(genes, [](const Parameter& p) {
    return std::ranges::count(decimators(), p.name, &DecimatorDescription::monotone) > 0;
  });
  if (!settings.config.search.monotone_walk || gene == genes.end() || gene->fixed ||
      !(gene->lower < gene->upper)) {
    return std::nullopt;
  }
  const auto position = static_cast<std::size_t>(gene - genes.begin());
  for (const LinearConstraint& constraint : settings.config.linear) {
    for (const auto& [held, coefficient] : constraint.terms) {
      if (held == position) return std::nullopt;
    }
  }
  return position;
}

Problem search_problem(const OptimizeSettings& settings) {
  const std::optional<std::size_t> walked = walked_gene(settings);
  const bool named = settings.decimator != kAutoDecimator && !walked;
  Problem problem = make_problem(
      settings.config, named ? decimator_named(settings.decimator).monotone : std::string_view());
  problem.nonlinear.resize(settings.bound.two_sided() ? 4 : 1);
  begin_with_fitted(problem, settings);
  begin_without_planes_too(problem);
  if (!walked) return problem;
  Gene& gene = problem.genes[*walked];
  gene.upper = gene.lower;
  for (Genes& start : problem.starts) start[*walked] = gene.lower;
  problem.stepped = true;
  add_generous_starts(problem);
  return problem;
}

ChainSettings chain_of(const OptimizeSettings& settings, const Problem& problem,
                       const Genes& genes) {
  ParameterValues::ByName values;
  for (std::size_t i = 0; i < genes.size(); ++i) values[problem.genes.at(i).name] = genes[i];
  return chain_settings(settings.method, settings.decimator, ParameterValues(std::move(values)));
}

std::vector<double> constraints_of(const ChainResult& made, const MeasuredError& error,
                                   const DecimationBound& bound) {
  if (!bound.two_sided()) return {error.violation};
  const auto difference = static_cast<double>(made.topology_difference);
  return {error.violation, made.back_distance / bound.epsilon_back - 1,
          made.reference_distance / bound.epsilon - 1,
          difference > 0 ? difference / (1 + difference) : -1};
}

}  // namespace emax
