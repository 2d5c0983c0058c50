#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "benchmark_problems.h"
#include "host/genocop/random_stream.h"

namespace emax::benchmark {

// Shaped like the real job: a triangle count, a staircase that falls with the gene `reduction`,
// and an error that grows with it, jumps by up to `roughness` from point to point, and depends with
// the count on the other genes (3 continuous, 2 integer, 1 category). The start is a standard
// setting: feasible at a small reduction, well off the optimum.
inline BenchmarkProblem staircase(double roughness = 0.03) {
  using Kind = Gene::Kind;
  Problem p;
  p.genes = {{"radius", Kind::kContinuous, 2, 14},      {"mu", Kind::kContinuous, 2, 6},
             {"neighbours", Kind::kInteger, 50, 300},   {"k", Kind::kInteger, 6, 40},
             {"reduction", Kind::kContinuous, 0, 0.98}, {"feature", Kind::kContinuous, 5, 60},
             {"split", Kind::kCategorical, 0, 1}};
  p.starts = {{6, 2.5, 100, 20, 0.5, 15, 1}};
  p.monotone_gene = 4;
  const auto evaluate = [roughness](const Genes& x) {
    const auto sq = [](double v) { return v * v; };
    const double radius = (x[0] - 3.5) / 12, mu = (x[1] - 4.6) / 4, nn = (x[2] - 210) / 250,
                 k = (x[3] - 31) / 34, feature = (x[5] - 38) / 55;
    const double factor = 1 + 0.05 * sq(radius) + 0.03 * sq(mu) + 0.02 * nn * radius;
    const double count = std::floor(71000 * (1 - x[4]) * factor);
    const double quality = 1 + 1.2 * sq(radius) + 0.8 * sq(mu) + 0.3 * sq(nn) + 0.5 * sq(k) +
                           0.7 * sq(feature) + 0.4 * mu * feature + 0.25 * x[6];
    // Pseudo-random but a function of the genes, as a real library's error is.
    std::uint64_t hash = 0;
    for (double v : x) {
      hash = RandomStream(hash, static_cast<std::uint64_t>(v * 1e9), RandomStream::Purpose::kTest)
                 .bits();
    }
    const double noise = 1 + roughness * (static_cast<double>(hash >> 11) * 0x1p-53 - 0.5) * 2;
    const double error = 0.08 * quality * noise / std::pow(1.02 - x[4], 1.1);
    return Evaluation{std::isfinite(error), count, error / 0.5 - 1};
  };
  // At the best other genes and the luckiest error: 0.08 (1-roughness) / (1.02-x)^1.1 = 0.5.
  const double best = 1.02 - std::pow(0.16 * (1 - roughness), 1 / 1.1);
  return {"staircase", p, evaluate, std::floor(71000 * (1 - best))};
}

}  // namespace emax::benchmark
