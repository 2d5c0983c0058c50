#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "benchmark_problems.h"

// A test function as the peers get it: numbers alone. Linear constraints come after the nonlinear
// ones, as values that are at most 0.
namespace emax::benchmark {

struct PeerSizes {
  std::size_t genes, inequalities, equalities;
};

// Where evaluations tell the greatest violation alone, that is the one nonlinear constraint.
inline bool has_violation_alone(const BenchmarkProblem& bench) {
  return bench.problem.nonlinear.empty() && bench.problem.linear.empty();
}

inline PeerSizes peer_sizes(const BenchmarkProblem& bench) {
  const Problem& p = bench.problem;
  std::size_t equalities = 0;
  for (const auto& constraint : p.nonlinear) equalities += constraint.tolerance > 0;
  const std::size_t values = has_violation_alone(bench) ? 1 : p.nonlinear.size();
  return {p.genes.size(), values - equalities + p.linear.size(), equalities};
}

// Lower, upper, 1 if whole, the start (NaN: none).
inline std::array<double, 4> peer_gene(const BenchmarkProblem& bench, std::size_t i) {
  const Problem& p = bench.problem;
  const Gene& gene = p.genes.at(i);
  return {gene.lower, gene.upper, gene.is_whole() ? 1.0 : 0.0,
          p.starts.empty() ? std::nan("") : p.starts.front()[i]};
}

// Objective, equalities, inequalities.
inline std::vector<double> peer_values(const BenchmarkProblem& bench, const Genes& x) {
  const Evaluation e = bench.evaluate(x);
  std::vector<double> values = {e.evaluated_ok ? e.objective : INFINITY};
  for (const bool equalities : {true, false}) {
    for (std::size_t c = 0; c < e.constraints.size(); ++c) {
      if ((bench.problem.nonlinear[c].tolerance > 0) == equalities) {
        values.push_back(e.constraints[c]);
      }
    }
  }
  if (has_violation_alone(bench)) values.push_back(e.evaluated_ok ? e.violation : INFINITY);
  for (const auto& constraint : bench.problem.linear) {
    double sum = -constraint.bound;
    for (const auto& [gene, coefficient] : constraint.terms) sum += coefficient * x[gene];
    values.push_back(sum);
  }
  return values;
}

}  // namespace emax::benchmark
