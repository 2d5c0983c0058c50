#include "host/genocop/local_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "benchmark_problems.h"
#include "host/genocop/linear_step.h"
#include "host/genocop/random_stream.h"

namespace emax {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Matrix random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  RandomStream random(seed, 0, RandomStream::Purpose::kTest);
  Matrix m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m(i) = random.uniform(-1, 1);
  return m;
}

TEST(LocalModel, LeastSquaresFindLinearResponsesExactly) {
  const Matrix steps = random_matrix(12, 4, 1), gradients = random_matrix(4, 3, 2);
  const Vector centre = random_matrix(3, 1, 3);
  const Matrix values = (steps * gradients).rowwise() + centre.transpose();
  const LocalModel model = fit_linear(steps, values, centre, Vector::LinSpaced(12, 1, 3));
  EXPECT_LT((model.gradients - gradients).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LocalSpace, StepsStayNearerToTheirCentreThanToFailures) {
  Problem problem;
  problem.genes = benchmark::continuous_genes(4, 0, 1);
  const LinearDomain domain(problem);
  const Genes centre(4, 0.5), elsewhere = {0.5, 0.5, 0.51, 0.6};
  LocalSpace space(domain, problem, {0, 1, 2}, centre);  // the last gene is held
  space.failed(elsewhere);
  const Matrix failures = random_matrix(4, 3, 9) * 0.4;
  for (Eigen::Index f = 0; f < failures.rows(); ++f) {
    space.failed(space.moved(centre, failures.row(f).transpose()));
  }
  constexpr double kRadius = 0.3;
  Matrix rows;
  Vector bounds;
  space.linear_rows(centre, kRadius, rows, bounds);
  const Matrix steps = random_matrix(500, 3, 10) * kRadius;
  int barred = 0;
  for (Eigen::Index s = 0; s < steps.rows(); ++s) {
    const Vector step = steps.row(s).transpose();
    bool nearer = false;
    for (Eigen::Index f = 0; f < failures.rows(); ++f) {
      nearer = nearer || (step - failures.row(f).transpose()).norm() < step.norm();
    }
    EXPECT_EQ((rows * step - bounds).maxCoeff() > 0, nearer);
    EXPECT_EQ(space.nears_a_failure(centre, space.moved(centre, step)), nearer);
    barred += nearer;
  }
  EXPECT_GT(barred, 50);
  EXPECT_LT(barred, 450);
}

// As many points as a quadratic function has coefficients leave nothing open.
TEST(LocalModel, EnoughPointsGiveAQuadraticFunctionBack) {
  constexpr Eigen::Index kN = 4;
  const Matrix half = random_matrix(kN, kN, 4);
  const Matrix hessian = half + half.transpose();
  const Vector gradient = random_matrix(kN, 1, 5);
  const Matrix steps = random_matrix((kN + 1) * (kN + 2) / 2 - 1, kN, 6);
  Matrix values(steps.rows(), 1);
  for (Eigen::Index i = 0; i < steps.rows(); ++i) {
    const Vector s = steps.row(i).transpose();
    values(i, 0) = 7 + gradient.dot(s) + 0.5 * s.dot(hessian * s);
  }
  const LocalModel model = fit_quadratic(steps, values, Vector::Constant(1, 7), {});
  EXPECT_LT((model.gradients.col(0) - gradient).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((model.hessians[0] - hessian).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(LocalModel, FewPointsAreInterpolatedAndRightCurvatureIsKept) {
  constexpr Eigen::Index kN = 5;
  const Matrix half = random_matrix(kN, kN, 7);
  const Matrix hessian = half + half.transpose();
  const Matrix steps = random_matrix(kN + 2, kN, 8);
  Matrix values(steps.rows(), 1);
  for (Eigen::Index i = 0; i < steps.rows(); ++i) {
    values(i, 0) = 0.5 * steps.row(i).dot(hessian * steps.row(i).transpose());
  }
  const LocalModel cold = fit_quadratic(steps, values, Vector::Zero(1), {});
  for (Eigen::Index i = 0; i < steps.rows(); ++i) {
    EXPECT_NEAR(cold.at(steps.row(i).transpose())[0], values(i, 0), 1e-8);
  }
  EXPECT_GT((cold.hessians[0] - hessian).norm(), 0.1);  // seven values cannot tell fifteen numbers
  const LocalModel warm = fit_quadratic(steps, values, Vector::Zero(1), {hessian});
  EXPECT_LT((warm.hessians[0] - hessian).norm(), 1e-8);
}

// min -x - 2y in the unit square with x + y <= 1 (linear) and 3x + y <= 1.5 (told by values): the
// optimum is (0, 1), and with y <= 0.6 told as well (0.3, 0.6).
Problem linear_problem(std::size_t told) {
  Problem p;
  p.genes = benchmark::continuous_genes(2, 0, 1);
  p.linear = {benchmark::at_most({{1, 1}, {2, 1}}, 1)};
  benchmark::constrain(p, told);
  return p;
}

Evaluation linear_evaluation(const Problem& p, const Genes& g) {
  std::vector<double> values = {3 * g[0] + g[1] - 1.5, g[1] - 0.6};
  values.resize(p.nonlinear.size());
  return make_evaluation(p.nonlinear, -g[0] - 2 * g[1], std::move(values));
}

TEST(LinearStep, SolvesALinearProgramInOneStep) {
  for (const auto& [told, best] :
       {std::pair{std::size_t{1}, Genes{0, 1}}, std::pair{std::size_t{2}, Genes{0.3, 0.6}}}) {
    const Problem p = linear_problem(told);
    const LinearDomain domain(p);
    LinearStep step(domain, p, {0, 1});
    const Genes centre = {0.2, 0.3};
    const Evaluation at_centre = linear_evaluation(p, centre);
    RandomStream random(1, 0, RandomStream::Purpose::kTest);
    step.told(centre, at_centre);
    EXPECT_EQ(step.propose(centre, at_centre, random), std::nullopt);  // nothing to learn from
    for (const Genes& point : {Genes{0.3, 0.3}, Genes{0.2, 0.5}, Genes{0.1, 0.1}}) {
      step.told(point, linear_evaluation(p, point));
    }
    for (int grow = 0; grow < 6; ++grow) step.judge(true);
    Genes at = centre;
    for (int i = 0; i < 6; ++i) {
      const auto next = step.propose(at, linear_evaluation(p, at), random);
      if (!next) break;  // nothing left to gain
      at = *next;
    }
    EXPECT_NEAR(at[0], best[0], 1e-7);
    EXPECT_NEAR(at[1], best[1], 1e-7);
    EXPECT_TRUE(domain.contains(at));
  }
}

TEST(LinearStep, FailuresNarrowTheTrustRegionAndSuccessWidensIt) {
  const Problem p = linear_problem(1);
  const LinearDomain domain(p);
  LinearStep step(domain, p, {0, 1});
  const double first = step.radius();
  step.judge(false);
  EXPECT_LT(step.radius(), first);
  step.judge(true);
  step.judge(true);
  EXPECT_GT(step.radius(), first);
  for (int i = 0; i < 100; ++i) step.judge(false);
  EXPECT_GE(step.radius(), 0.01);
}

}  // namespace
}  // namespace emax
