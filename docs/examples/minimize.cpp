// Genocop III on a function of one's own: a box of the least surface that holds a litre.
#include <emax/genocop.h>

#include <cmath>
#include <cstdio>

int main() {
  emax::Problem problem;
  for (const char* side : {"width", "depth", "height"}) {
    problem.genes.push_back({.name = side, .lower = 0.2, .upper = 5});  // decimetres
  }
  problem.linear = {{.terms = {{0, 1.0}, {1, -1.0}}, .bound = 0}};  // width <= depth
  problem.nonlinear = {{}};                                         // value <= 0

  const emax::Minimum box = emax::minimize(
      problem,
      [&](const emax::Genes& side) {
        const double surface = 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
        return emax::make_evaluation(problem.nonlinear, surface, {1 - side[0] * side[1] * side[2]});
      },
      {.budget = 400, .seed = 1});

  std::printf("%.2f x %.2f x %.2f dm, surface %.3f dm2 (the cube has 6), %s\n", box.genes[0],
              box.genes[1], box.genes[2], box.evaluation.objective,
              box.evaluation.feasible() ? "holds a litre" : "too small");
}
