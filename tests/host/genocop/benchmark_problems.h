#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <emax/genocop.h>

// The constrained test functions g01 to g11 (Michalewicz & Schoenauer 1996; Runarsson & Yao 2000).
// Linear constraints are given as such; the values of the others are divided by the scale of their
// terms. Equalities count as met within 1e-4, which is why optima of g03, g05 and g11 are
// quoted for that tolerance.
namespace emax::benchmark {

struct BenchmarkProblem {
  std::string name;
  Problem problem;
  std::function<Evaluation(const Genes&)> evaluate;
  double optimum;
};

inline std::vector<Gene> continuous_genes(
    std::initializer_list<std::pair<double, double>> domains) {
  std::vector<Gene> genes;
  for (const auto& [lower, upper] : domains) {
    genes.push_back(
        {"x" + std::to_string(genes.size() + 1), Gene::Kind::kContinuous, lower, upper});
  }
  return genes;
}

inline std::vector<Gene> continuous_genes(std::size_t count, double lower, double upper) {
  std::vector<Gene> genes;
  for (std::size_t i = 1; i <= count; ++i) {
    genes.push_back({"x" + std::to_string(i), Gene::Kind::kContinuous, lower, upper});
  }
  return genes;
}

// Genes are counted from 1 here, as the published formulas do.
inline LinearConstraint at_most(std::initializer_list<std::pair<std::size_t, double>> terms,
                                double bound) {
  LinearConstraint constraint{{}, LinearConstraint::Relation::kAtMost, bound};
  for (const auto& [gene, coefficient] : terms)
    constraint.terms.emplace_back(gene - 1, coefficient);
  return constraint;
}

// Inequalities first, equalities after them; every value at most 0 or 0.
inline void constrain(Problem& p, std::size_t inequalities, std::size_t equalities = 0) {
  using Relation = LinearConstraint::Relation;
  p.nonlinear.assign(inequalities, {Relation::kAtMost, 0});
  p.nonlinear.resize(inequalities + equalities, {Relation::kEqual, 1e-4});
}

inline BenchmarkProblem made(
    const char* name, Problem p,
    std::function<std::pair<double, std::vector<double>>(const Genes&)> values, double optimum) {
  auto evaluate = [nonlinear = p.nonlinear, values = std::move(values)](const Genes& x) {
    auto [objective, constraints] = values(x);
    return make_evaluation(nonlinear, objective, std::move(constraints));
  };
  return {name, std::move(p), std::move(evaluate), optimum};
}

using Values = std::pair<double, std::vector<double>>;

inline BenchmarkProblem g01() {
  Problem p;
  p.genes = continuous_genes(13, 0, 1);
  for (std::size_t i : {9u, 10u, 11u}) p.genes[i].upper = 100;
  p.linear = {at_most({{1, 2}, {2, 2}, {10, 1}, {11, 1}}, 10),
              at_most({{1, 2}, {3, 2}, {10, 1}, {12, 1}}, 10),
              at_most({{2, 2}, {3, 2}, {11, 1}, {12, 1}}, 10),
              at_most({{1, -8}, {10, 1}}, 0),
              at_most({{2, -8}, {11, 1}}, 0),
              at_most({{3, -8}, {12, 1}}, 0),
              at_most({{4, -2}, {5, -1}, {10, 1}}, 0),
              at_most({{6, -2}, {7, -1}, {11, 1}}, 0),
              at_most({{8, -2}, {9, -1}, {12, 1}}, 0)};
  const auto values = [](const Genes& x) -> Values {
    double f = 0;
    for (std::size_t i = 0; i < 4; ++i) f += 5 * x[i] - 5 * x[i] * x[i];
    for (std::size_t i = 4; i < 13; ++i) f -= x[i];
    return {f, {}};
  };
  return made("g01", p, values, -15);
}

inline BenchmarkProblem g02() {
  constexpr std::size_t kCount = 20;
  Problem p;
  p.genes = continuous_genes(kCount, 0, 10);
  LinearConstraint sum{{}, LinearConstraint::Relation::kAtMost, 7.5 * kCount};
  for (std::size_t i = 0; i < kCount; ++i) sum.terms.emplace_back(i, 1.0);
  p.linear = {sum};
  constrain(p, 1);
  const auto values = [](const Genes& x) -> Values {
    double fourth = 0, square = 1, weighted = 0, product = 1;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double c = std::cos(x[i]);
      fourth += c * c * c * c;
      square *= c * c;
      weighted += static_cast<double>(i + 1) * x[i] * x[i];
      product *= x[i];
    }
    return {-std::abs((fourth - 2 * square) / std::sqrt(weighted)), {0.75 - product}};
  };
  return made("g02", p, values, -0.803619);
}

inline BenchmarkProblem g03() {
  Problem p;
  p.genes = continuous_genes(10, 0, 1);
  constrain(p, 0, 1);
  const auto values = [](const Genes& x) -> Values {
    double product = 1, norm = 0;
    for (double v : x) {
      product *= std::sqrt(10.0) * v;
      norm += v * v;
    }
    return {-product, {norm - 1}};
  };
  return made("g03", p, values, -1.0005001);
}

inline BenchmarkProblem g04() {
  Problem p;
  p.genes = continuous_genes({{78, 102}, {33, 45}, {27, 45}, {27, 45}, {27, 45}});
  constrain(p, 6);
  const auto values = [](const Genes& x) -> Values {
    const double u =
        85.334407 + 0.0056858 * x[1] * x[4] + 0.0006262 * x[0] * x[3] - 0.0022053 * x[2] * x[4];
    const double v =
        80.51249 + 0.0071317 * x[1] * x[4] + 0.0029955 * x[0] * x[1] + 0.0021813 * x[2] * x[2];
    const double w =
        9.300961 + 0.0047026 * x[2] * x[4] + 0.0012547 * x[0] * x[2] + 0.0019085 * x[2] * x[3];
    const double f =
        5.3578547 * x[2] * x[2] + 0.8356891 * x[0] * x[4] + 37.293239 * x[0] - 40792.141;
    return {f, {-u, u - 92, 90 - v, v - 110, 20 - w, w - 25}};
  };
  return made("g04", p, values, -30665.538672);
}

inline BenchmarkProblem g05() {
  Problem p;
  p.genes = continuous_genes({{0, 1200}, {0, 1200}, {-0.55, 0.55}, {-0.55, 0.55}});
  p.linear = {at_most({{3, 1}, {4, -1}}, 0.55), at_most({{4, 1}, {3, -1}}, 0.55)};
  constrain(p, 0, 3);
  const auto values = [](const Genes& x) -> Values {
    const auto wave = [](double angle) { return 1000 * std::sin(angle - 0.25); };
    const double f =
        3 * x[0] + 1e-6 * x[0] * x[0] * x[0] + 2 * x[1] + 2e-6 / 3 * x[1] * x[1] * x[1];
    return {
        f,
        {wave(-x[2]) + wave(-x[3]) + 894.8 - x[0], wave(x[2]) + wave(x[2] - x[3]) + 894.8 - x[1],
         wave(x[3]) + wave(x[3] - x[2]) + 1294.8}};
  };
  return made("g05", p, values, 5126.496714);
}

inline BenchmarkProblem g06() {
  Problem p;
  p.genes = continuous_genes({{13, 100}, {0, 100}});
  constrain(p, 2);
  const auto values = [](const Genes& x) -> Values {
    const auto square = [](double v) { return v * v; };
    const double f = square(x[0] - 10) * (x[0] - 10) + square(x[1] - 20) * (x[1] - 20);
    return {
        f,
        {100 - square(x[0] - 5) - square(x[1] - 5), square(x[0] - 6) + square(x[1] - 5) - 82.81}};
  };
  return made("g06", p, values, -6961.813876);
}

inline BenchmarkProblem g07() {
  Problem p;
  p.genes = continuous_genes(10, -10, 10);
  p.linear = {at_most({{1, 4}, {2, 5}, {7, -3}, {8, 9}}, 105),
              at_most({{1, 10}, {2, -8}, {7, -17}, {8, 2}}, 0),
              at_most({{1, -8}, {2, 2}, {9, 5}, {10, -2}}, 12)};
  constrain(p, 5);
  const auto values = [](const Genes& x) -> Values {
    const auto sq = [](double v) { return v * v; };
    const double f = sq(x[0]) + sq(x[1]) + x[0] * x[1] - 14 * x[0] - 16 * x[1] + sq(x[2] - 10) +
                     4 * sq(x[3] - 5) + sq(x[4] - 3) + 2 * sq(x[5] - 1) + 5 * sq(x[6]) +
                     7 * sq(x[7] - 11) + 2 * sq(x[8] - 10) + sq(x[9] - 7) + 45;
    return {f,
            {3 * sq(x[0] - 2) + 4 * sq(x[1] - 3) + 2 * sq(x[2]) - 7 * x[3] - 120,
             5 * sq(x[0]) + 8 * x[1] + sq(x[2] - 6) - 2 * x[3] - 40,
             sq(x[0]) + 2 * sq(x[1] - 2) - 2 * x[0] * x[1] + 14 * x[4] - 6 * x[5],
             0.5 * sq(x[0] - 8) + 2 * sq(x[1] - 4) + 3 * sq(x[4]) - x[5] - 30,
             -3 * x[0] + 6 * x[1] + 12 * sq(x[8] - 8) - 7 * x[9]}};
  };
  return made("g07", p, values, 24.306209);
}

inline BenchmarkProblem g08() {
  Problem p;
  p.genes = continuous_genes(2, 0, 10);
  constrain(p, 2);
  const auto values = [](const Genes& x) -> Values {
    constexpr double kTwoPi = 6.283185307179586;
    const double s = std::sin(kTwoPi * x[0]);
    const double f = -s * s * s * std::sin(kTwoPi * x[1]) / (x[0] * x[0] * x[0] * (x[0] + x[1]));
    return {f, {x[0] * x[0] - x[1] + 1, 1 - x[0] + (x[1] - 4) * (x[1] - 4)}};
  };
  return made("g08", p, values, -0.095825);
}

inline BenchmarkProblem g09() {
  Problem p;
  p.genes = continuous_genes(7, -10, 10);
  constrain(p, 4);
  const auto values = [](const Genes& x) -> Values {
    const auto sq = [](double v) { return v * v; };
    const double f = sq(x[0] - 10) + 5 * sq(x[1] - 12) + sq(sq(x[2])) + 3 * sq(x[3] - 11) +
                     10 * sq(x[4]) * sq(sq(x[4])) + 7 * sq(x[5]) + sq(sq(x[6])) - 4 * x[5] * x[6] -
                     10 * x[5] - 8 * x[6];
    return {f,
            {-127 + 2 * sq(x[0]) + 3 * sq(sq(x[1])) + x[2] + 4 * sq(x[3]) + 5 * x[4],
             -282 + 7 * x[0] + 3 * x[1] + 10 * sq(x[2]) + x[3] - x[4],
             -196 + 23 * x[0] + sq(x[1]) + 6 * sq(x[5]) - 8 * x[6],
             4 * sq(x[0]) + sq(x[1]) - 3 * x[0] * x[1] + 2 * sq(x[2]) + 5 * x[5] - 11 * x[6]}};
  };
  return made("g09", p, values, 680.630057);
}

inline BenchmarkProblem g10() {
  Problem p;
  p.genes = continuous_genes({{100, 10000},
                              {1000, 10000},
                              {1000, 10000},
                              {10, 1000},
                              {10, 1000},
                              {10, 1000},
                              {10, 1000},
                              {10, 1000}});
  p.linear = {at_most({{4, 0.0025}, {6, 0.0025}}, 1),
              at_most({{4, -0.0025}, {5, 0.0025}, {7, 0.0025}}, 1),
              at_most({{5, -0.01}, {8, 0.01}}, 1)};
  constrain(p, 3);
  const auto values = [](const Genes& x) -> Values {
    return {x[0] + x[1] + x[2],
            {(-x[0] * x[5] + 833.33252 * x[3] + 100 * x[0] - 83333.333) / 83333.333,
             (-x[1] * x[6] + 1250 * x[4] + x[1] * x[3] - 1250 * x[3]) / 1e5,
             (-x[2] * x[7] + 1250000 + x[2] * x[4] - 2500 * x[4]) / 1.25e6}};
  };
  return made("g10", p, values, 7049.248021);
}

inline BenchmarkProblem g11() {
  Problem p;
  p.genes = continuous_genes(2, -1, 1);
  constrain(p, 0, 1);
  const auto values = [](const Genes& x) -> Values {
    return {x[0] * x[0] + (x[1] - 1) * (x[1] - 1), {x[1] - x[0] * x[0]}};
  };
  return made("g11", p, values, 0.7499);
}

inline std::vector<BenchmarkProblem> all_problems() {
  return {g01(), g02(), g03(), g04(), g05(), g06(), g07(), g08(), g09(), g10(), g11()};
}

}  // namespace emax::benchmark
