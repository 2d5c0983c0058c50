// The functions of tests/host/genocop with C linkage, so that the peers in Python evaluate the very
// same ones. Linear constraints come after the nonlinear ones, as values that are at most 0.
#include <cstddef>
#include <cstring>
#include <vector>

#include "benchmark_problems.h"
#include "staircase.h"

namespace {

using emax::benchmark::BenchmarkProblem;

const std::vector<BenchmarkProblem>& problems() {
  static const std::vector<BenchmarkProblem> all = [] {
    std::vector<BenchmarkProblem> list = emax::benchmark::all_problems();
    list.push_back(emax::benchmark::staircase());
    return list;
  }();
  return all;
}

}  // namespace

extern "C" {

// -1 for an unknown name.
int emax_problem(const char* name) {
  for (std::size_t i = 0; i < problems().size(); ++i) {
    if (problems()[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

// Genes, inequalities, equalities.
void emax_sizes(int problem, int* sizes) {
  const emax::Problem& p = problems()[static_cast<std::size_t>(problem)].problem;
  int equalities = 0;
  for (const auto& constraint : p.nonlinear) equalities += constraint.tolerance > 0;
  const int values =
      p.nonlinear.empty() && p.linear.empty() ? 1 : static_cast<int>(p.nonlinear.size());
  sizes[0] = static_cast<int>(p.genes.size());
  sizes[1] = values - equalities + static_cast<int>(p.linear.size());
  sizes[2] = equalities;
}

// For each gene: lower, upper, 1 if whole, the start (NaN: none).
void emax_genes(int problem, double* values) {
  const emax::Problem& p = problems()[static_cast<std::size_t>(problem)].problem;
  for (std::size_t i = 0; i < p.genes.size(); ++i) {
    const emax::Gene& gene = p.genes[i];
    *values++ = gene.lower;
    *values++ = gene.upper;
    *values++ = gene.is_whole();
    *values++ = p.starts.empty() ? std::nan("") : p.starts.front()[i];
  }
}

double emax_optimum(int problem) { return problems()[static_cast<std::size_t>(problem)].optimum; }

// `values`: objective, equalities, inequalities.
void emax_evaluate(int problem, const double* genes, double* values) {
  const BenchmarkProblem& bench = problems()[static_cast<std::size_t>(problem)];
  const emax::Genes x(genes, genes + bench.problem.genes.size());
  const emax::Evaluation e = bench.evaluate(x);
  *values++ = e.objective;
  for (const bool equalities : {true, false}) {
    for (std::size_t c = 0; c < e.constraints.size(); ++c) {
      if ((bench.problem.nonlinear[c].tolerance > 0) == equalities) *values++ = e.constraints[c];
    }
  }
  if (bench.problem.nonlinear.empty() && bench.problem.linear.empty()) *values++ = e.violation;
  for (const auto& constraint : bench.problem.linear) {
    double sum = -constraint.bound;
    for (const auto& [gene, coefficient] : constraint.terms) sum += coefficient * x[gene];
    *values++ = sum;
  }
}
}
