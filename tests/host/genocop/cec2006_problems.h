#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include "benchmark_problems.h"

// The constrained test functions that the competition of CEC 2006 added and whose optimum is known
// (Liang, Runarsson, Mezura-Montes, Clerc, Suganthan, Coello Coello & Deb 2006): g12 to g19, g21,
// g23 and g24. Values are as published, of whatever scale. The quoted optima use the tolerance of
// 1e-4 of an equality, linear ones included, so these are nonlinear constraints here.
namespace emax::benchmark {

inline BenchmarkProblem g12() {
  Problem p;
  p.genes = continuous_genes(3, 0, 10);
  constrain(p, 1);
  const auto values = [](const Genes& x) -> Values {
    double from_middle = 0, from_centre = 0;  // squared; centres have whole coordinates 1 to 9
    for (double v : x) {
      const double centre = std::clamp(std::round(v), 1.0, 9.0);
      from_middle += (v - 5) * (v - 5);
      from_centre += (v - centre) * (v - centre);
    }
    return {from_middle / 100 - 1, {from_centre - 0.0625}};
  };
  return made("g12", p, values, -1);
}

inline BenchmarkProblem g13() {
  Problem p;
  p.genes = continuous_genes({{-2.3, 2.3}, {-2.3, 2.3}, {-3.2, 3.2}, {-3.2, 3.2}, {-3.2, 3.2}});
  constrain(p, 0, 3);
  const auto values = [](const Genes& x) -> Values {
    double product = 1, norm = 0;
    for (double v : x) {
      product *= v;
      norm += v * v;
    }
    return {
        std::exp(product),
        {norm - 10, x[1] * x[2] - 5 * x[3] * x[4], x[0] * x[0] * x[0] + x[1] * x[1] * x[1] + 1}};
  };
  return made("g13", p, values, 0.053941514);
}

inline BenchmarkProblem g14() {
  Problem p;
  p.genes = continuous_genes(10, 0, 10);
  constrain(p, 0, 3);
  const auto values = [](const Genes& x) -> Values {
    constexpr std::array kFree = {-6.089,  -17.164, -34.054, -5.914,  -24.721,
                                  -14.986, -24.1,   -10.708, -26.662, -22.179};
    double total = 0, f = 0;
    for (double v : x) total += v;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (x[i] > 0) f += x[i] * (kFree[i] + std::log(x[i] / total));
    }
    return {f,
            {x[0] + 2 * x[1] + 2 * x[2] + x[5] + x[9] - 2, x[3] + 2 * x[4] + x[5] + x[6] - 1,
             x[2] + x[6] + x[7] + 2 * x[8] + x[9] - 1}};
  };
  return made("g14", p, values, -47.7648884595);
}

inline BenchmarkProblem g15() {
  Problem p;
  p.genes = continuous_genes(3, 0, 10);
  constrain(p, 0, 2);
  const auto values = [](const Genes& x) -> Values {
    const double f = 1000 - x[0] * x[0] - 2 * x[1] * x[1] - x[2] * x[2] - x[0] * x[1] - x[0] * x[2];
    return {f,
            {x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 25, 8 * x[0] + 14 * x[1] + 7 * x[2] - 56}};
  };
  return made("g15", p, values, 961.7150222899);
}

inline BenchmarkProblem g16() {
  Problem p;
  p.genes = continuous_genes(
      {{704.4148, 906.3855}, {68.6, 288.88}, {0, 134.75}, {193, 287.0966}, {25, 84.1988}});
  p.linear = {at_most({{2, -1.5}, {3, 1}}, 0), at_most({{2, -1}, {3, -1}}, 41.6 - 213.1),
              at_most({{2, 1}, {3, 1}}, 405.23 - 41.6)};
  constrain(p, 35);
  // y and c are counted from 1, as the published formulas do.
  const auto values = [](const Genes& x) -> Values {
    const double x1 = x[0], x2 = x[1], x3 = x[2], x4 = x[3], x5 = x[4];
    const double y1 = x2 + x3 + 41.6;
    const double y2 = 12.5 / (0.024 * x4 - 4.62) + 12;
    const double y3 = (0.0003535 * x1 * x1 + 0.5311 * x1 + 0.08705 * y2 * x1) /
                      (0.052 * x1 + 78 + 0.002377 * y2 * x1);
    const double y4 = 19 * y3;
    const double c4 =
        0.04782 * (x1 - y3) + 0.1956 * (x1 - y3) * (x1 - y3) / x2 + 0.6376 * y4 + 1.594 * y3;
    const double y5 = (x1 - y3 - y4) * (0.95 - c4 / (100 * x2));
    const double y6 = x1 - y5 - y4 - y3;
    const double c8 = (y5 + y4) * 0.995;
    const double y7 = c8 / y1, y8 = c8 / 3798;
    const double y9 = 96.82 / (y7 - 0.0663 * y7 / y8 - 0.3153) + 0.321 * y1;
    const double y10 = 1.29 * y5 + 1.258 * y4 + 2.29 * y3 + 1.71 * y6;
    const double y11 = 1.71 * x1 - 0.452 * y4 + 0.58 * y3;
    const double c12 = 0.995 * y10 + 1998;
    const double y12 = 12.3 / 752.3 * x1 + 1.75 * y2 * 0.995 * x1 / c12;
    const double y13 = c12 - 1.75 * y2;
    const double y14 = 3623 + 64.4 * x2 + 58.4 * x3 + 146312 / (y9 + x5);
    const double y15 = y13 / (0.995 * y10 + 60.8 * x2 + 48 * x4 - 0.1121 * y14 - 5095);
    const double y16 = 148000 - 331000 * y15 + 40 * y13 - 61 * y15 * y13;
    const double y17 = 14130000 - 1328 * y10 - 531 * y11 + (2324 * y10 - 28740000 * y2) / c12;
    const double c15 = y13 / y15 - y13 / 0.52, c16 = 1.104 - 0.72 * y15;
    const double f = -(5.843e-7 * y17 - 1.17e-4 * y14 - 0.1365 - 2.358e-5 * y13 - 1.502e-6 * y16 -
                       0.0321 * y12 - 0.004324 * y5 - 1e-4 * c15 / c16 - 37.48 * y2 / c12);
    std::vector<double> constraints = {0.28 / 0.72 * y5 - y4, 3496 * y2 / c12 - 21,
                                       110.6 + y1 - 62212 / (y9 + x5)};
    for (const auto& [least, y, most] :
         std::initializer_list<std::array<double, 3>>{{17.505, y2, 1053.6667},
                                                      {11.275, y3, 35.03},
                                                      {214.228, y4, 665.585},
                                                      {7.458, y5, 584.463},
                                                      {0.961, y6, 265.916},
                                                      {1.612, y7, 7.046},
                                                      {0.146, y8, 0.222},
                                                      {107.99, y9, 273.366},
                                                      {922.693, y10, 1286.105},
                                                      {926.832, y11, 1444.046},
                                                      {18.766, y12, 537.141},
                                                      {1072.163, y13, 3247.039},
                                                      {8961.448, y14, 26844.086},
                                                      {0.063, y15, 0.386},
                                                      {71084.33, y16, 140000},
                                                      {2802713, y17, 12146108}}) {
      constraints.push_back(least - y);
      constraints.push_back(y - most);
    }
    return {f, std::move(constraints)};
  };
  return made("g16", p, values, -1.9051552586);
}

inline BenchmarkProblem g17() {
  Problem p;
  p.genes =
      continuous_genes({{0, 400}, {0, 1000}, {340, 420}, {340, 420}, {-1000, 1000}, {0, 0.5236}});
  constrain(p, 0, 4);
  const auto values = [](const Genes& x) -> Values {
    const double product = x[2] * x[3] / 131.078;
    const double third = 0.90798 * x[2] * x[2] / 131.078, fourth = 0.90798 * x[3] * x[3] / 131.078;
    const double first_load = 300 - product * std::cos(1.48477 - x[5]) + third * std::cos(1.47588);
    const double second_load = -product * std::cos(1.48477 + x[5]) + fourth * std::cos(1.47588);
    // Both costs jump.
    const double f = (x[0] < 300 ? 30 : 31) * first_load + (x[1] < 100   ? 28
                                                            : x[1] < 200 ? 29
                                                                         : 30) *
                                                               second_load;
    return {f,
            {first_load - x[0], second_load - x[1],
             -product * std::sin(1.48477 + x[5]) + fourth * std::sin(1.47588) - x[4],
             200 - product * std::sin(1.48477 - x[5]) + third * std::sin(1.47588)}};
  };
  return made("g17", p, values, 8853.5338748065);
}

inline BenchmarkProblem g18() {
  Problem p;
  p.genes = continuous_genes(9, -10, 10);
  p.genes[8] = {"x9", Gene::Kind::kContinuous, 0, 20};
  constrain(p, 13);
  const auto values = [](const Genes& x) -> Values {
    const auto beyond = [](double a, double b) { return a * a + b * b - 1; };
    const double f =
        -0.5 * (x[0] * x[3] - x[1] * x[2] + x[2] * x[8] - x[4] * x[8] + x[4] * x[7] - x[5] * x[6]);
    return {f,
            {beyond(x[2], x[3]), beyond(x[8], 0), beyond(x[4], x[5]), beyond(x[0], x[1] - x[8]),
             beyond(x[0] - x[4], x[1] - x[5]), beyond(x[0] - x[6], x[1] - x[7]),
             beyond(x[2] - x[4], x[3] - x[5]), beyond(x[2] - x[6], x[3] - x[7]),
             beyond(x[6], x[7] - x[8]), x[1] * x[2] - x[0] * x[3], -x[2] * x[8], x[4] * x[8],
             x[5] * x[6] - x[4] * x[7]}};
  };
  return made("g18", p, values, -0.8660254038);
}

inline BenchmarkProblem g19() {
  Problem p;
  p.genes = continuous_genes(15, 0, 10);
  constrain(p, 5);
  const auto values = [](const Genes& x) -> Values {
    constexpr std::array<std::array<double, 5>, 10> kA = {{{-16, 2, 0, 1, 0},
                                                           {0, -2, 0, 0.4, 2},
                                                           {-3.5, 0, 2, 0, 0},
                                                           {0, -2, 0, -4, -1},
                                                           {0, -9, -2, 1, -2.8},
                                                           {2, 0, -4, 0, 0},
                                                           {-1, -1, -1, -1, -1},
                                                           {-1, -2, -3, -2, -1},
                                                           {1, 2, 3, 4, 5},
                                                           {1, 1, 1, 1, 1}}};
    constexpr std::array<double, 10> kB = {-40, -2, -0.25, -4, -4, -1, -40, -60, 5, 1};
    constexpr std::array<std::array<double, 5>, 5> kC = {{{30, -20, -10, 32, -10},
                                                          {-20, 39, -6, -31, 32},
                                                          {-10, -6, 10, -6, -10},
                                                          {32, -31, -6, 39, -20},
                                                          {-10, 32, -10, -20, 30}}};
    constexpr std::array<double, 5> kD = {4, 8, 10, 6, 2}, kE = {-15, -27, -36, -18, -12};
    double f = 0;
    std::vector<double> constraints;
    for (std::size_t i = 0; i < 10; ++i) f -= kB[i] * x[i];
    for (std::size_t j = 0; j < 5; ++j) {
      const double y = x[10 + j];
      double row = 0, column = 0;
      for (std::size_t i = 0; i < 5; ++i) row += kC[i][j] * x[10 + i];
      for (std::size_t i = 0; i < 10; ++i) column += kA[i][j] * x[i];
      f += row * y + 2 * kD[j] * y * y * y;
      constraints.push_back(column - 2 * row - 3 * kD[j] * y * y - kE[j]);
    }
    return {f, std::move(constraints)};
  };
  return made("g19", p, values, 32.6555929502);
}

inline BenchmarkProblem g21() {
  Problem p;
  p.genes = continuous_genes(
      {{0, 1000}, {0, 40}, {0, 40}, {100, 300}, {6.3, 6.7}, {5.9, 6.4}, {4.5, 6.25}});
  constrain(p, 1, 5);
  const auto values = [](const Genes& x) -> Values {
    return {x[0],
            {35 * std::pow(x[1], 0.6) + 35 * std::pow(x[2], 0.6) - x[0],
             -300 * x[2] + 7500 * (x[4] - x[5]) - 25 * x[3] * (x[4] - x[5]) + x[2] * x[3],
             100 * x[1] + 155.365 * x[3] + 2500 * x[6] - x[1] * x[3] - 25 * x[3] * x[6] - 15536.5,
             std::log(900 - x[3]) - x[4], std::log(300 + x[3]) - x[5],
             std::log(700 - 2 * x[3]) - x[6]}};
  };
  return made("g21", p, values, 193.72451007);
}

inline BenchmarkProblem g23() {
  Problem p;
  p.genes = continuous_genes({{0, 300},
                              {0, 300},
                              {0, 100},
                              {0, 200},
                              {0, 100},
                              {0, 300},
                              {0, 100},
                              {0, 200},
                              {0.01, 0.03}});
  constrain(p, 2, 4);
  const auto values = [](const Genes& x) -> Values {
    return {6 * x[0] + 16 * x[1] - 9 * x[4] + 10 * (x[5] + x[6]) - 15 * x[7],
            {x[8] * x[2] + 0.02 * x[5] - 0.025 * x[4], x[8] * x[3] + 0.02 * x[6] - 0.015 * x[7],
             x[0] + x[1] - x[2] - x[3], 0.03 * x[0] + 0.01 * x[1] - x[8] * (x[2] + x[3]),
             x[2] + x[5] - x[4], x[3] + x[6] - x[7]}};
  };
  return made("g23", p, values, -400.0551);
}

inline BenchmarkProblem g24() {
  Problem p;
  p.genes = continuous_genes({{0, 3}, {0, 4}});
  constrain(p, 2);
  const auto values = [](const Genes& x) -> Values {
    const double a = x[0], square = a * a;
    return {-a - x[1],
            {-2 * square * square + 8 * square * a - 8 * square + x[1] - 2,
             -4 * square * square + 32 * square * a - 88 * square + 96 * a + x[1] - 36}};
  };
  return made("g24", p, values, -5.5080132716);
}

inline std::vector<BenchmarkProblem> cec2006_problems() {
  return {g12(), g13(), g14(), g15(), g16(), g17(), g18(), g19(), g21(), g23(), g24()};
}

}  // namespace emax::benchmark
