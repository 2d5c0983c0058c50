// The functions of tests/host/genocop with C linkage, so that the peers in Python evaluate the very
// same ones.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "benchmark_problems.h"
#include "cec2006_problems.h"
#include "peer_form.h"
#include "staircase.h"

namespace {

using emax::benchmark::BenchmarkProblem;

const std::vector<BenchmarkProblem>& problems() {
  static const std::vector<BenchmarkProblem> all = [] {
    std::vector<BenchmarkProblem> list = emax::benchmark::all_problems();
    for (BenchmarkProblem& more : emax::benchmark::cec2006_problems()) list.push_back(more);
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
  const auto of = emax::benchmark::peer_sizes(problems()[static_cast<std::size_t>(problem)]);
  for (const std::size_t size : {of.genes, of.inequalities, of.equalities}) {
    *sizes++ = static_cast<int>(size);
  }
}

// For each gene what peer_gene gives.
void emax_genes(int problem, double* values) {
  const BenchmarkProblem& bench = problems()[static_cast<std::size_t>(problem)];
  for (std::size_t i = 0; i < bench.problem.genes.size(); ++i) {
    values = std::ranges::copy(emax::benchmark::peer_gene(bench, i), values).out;
  }
}

double emax_optimum(int problem) { return problems()[static_cast<std::size_t>(problem)].optimum; }

// What peer_values gives.
void emax_evaluate(int problem, const double* genes, double* values) {
  const BenchmarkProblem& bench = problems()[static_cast<std::size_t>(problem)];
  const emax::Genes x(genes, genes + bench.problem.genes.size());
  std::ranges::copy(emax::benchmark::peer_values(bench, x), values);
}
}
