// Two known functions on Genocop III in C++, for the Python test to compare bits with: each line
// has the evaluations, the objective and the genes, as hexadecimal numbers.
#include <emax/genocop.h>

#include <cstdio>

namespace {

void print(const emax::Minimum& found) {
  std::printf("%zu %a", found.evaluations, found.evaluation.objective);
  for (const double gene : found.genes) std::printf(" %a", gene);
  std::printf("\n");
}

}  // namespace

int main() {
  // G06 of Michalewicz & Schoenauer: (10, 0) lies outside, the feasible region is a thin sickle.
  emax::Problem g06;
  g06.genes = {{.name = "x[0]", .lower = 13, .upper = 100},
               {.name = "x[1]", .lower = 0, .upper = 100}};
  g06.nonlinear = {{}, {}};
  print(emax::minimize(
      g06,
      [&](const emax::Genes& x) {
        const double a = x[0] - 10, b = x[1] - 20, c = x[0] - 5, d = x[1] - 5, e = x[0] - 6;
        return emax::make_evaluation(g06.nonlinear, a * a * a + b * b * b,
                                     {100 - (c * c + d * d), (e * e + d * d) - 82.81});
      },
      {.budget = 150, .seed = 3}));

  // Rosenbrock's valley above a line, the second variable whole.
  emax::Problem valley;
  valley.genes = {{.name = "x[0]", .lower = -2, .upper = 2},
                  {.name = "x[1]", .kind = emax::Gene::Kind::kInteger, .lower = -3, .upper = 3}};
  valley.linear = {{.terms = {{0, -1.0}, {1, -1.0}}, .bound = -0.5}};  // x0 + x1 >= 0.5
  print(emax::minimize(valley,
                       [&](const emax::Genes& x) {
                         const double a = 1 - x[0], b = x[1] - x[0] * x[0];
                         return emax::make_evaluation(valley.nonlinear, a * a + 100 * (b * b), {});
                       },
                       {.budget = 120, .seed = 7, .jobs = 2}));
}
