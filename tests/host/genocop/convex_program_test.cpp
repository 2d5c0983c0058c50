#include "host/genocop/convex_program.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "host/genocop/random_stream.h"

namespace emax {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Rows in the unit box [-1, 1]^n, `extra` random ones that hold at 0.
ConvexProgram random_program(RandomStream& random, Eigen::Index n, Eigen::Index extra) {
  ConvexProgram p;
  p.hessian = Matrix::Zero(n, n);
  p.gradient.resize(n);
  p.rows = Matrix::Zero(2 * n + extra, n);
  p.bounds = Vector::Ones(2 * n + extra);
  for (Eigen::Index i = 0; i < n; ++i) {
    p.gradient[i] = random.uniform(-1, 1);
    p.rows(2 * i, i) = 1;
    p.rows(2 * i + 1, i) = -1;
  }
  for (Eigen::Index r = 2 * n; r < p.rows.rows(); ++r) {
    for (Eigen::Index i = 0; i < n; ++i) p.rows(r, i) = random.uniform(-1, 1);
    p.bounds[r] = random.uniform(0.05, 0.5);
  }
  return p;
}

bool inside(const ConvexProgram& p, const Vector& x) {
  return ((p.rows * x - p.bounds).array() <= 1e-8).all();
}

// The twin: the best of all vertices.
double best_vertex(const ConvexProgram& p) {
  const Eigen::Index m = p.rows.rows();
  double best = HUGE_VAL;
  for (Eigen::Index a = 0; a < m; ++a) {
    for (Eigen::Index b = a + 1; b < m; ++b) {
      for (Eigen::Index c = b + 1; c < m; ++c) {
        Eigen::Matrix3d rows;
        rows << p.rows.row(a), p.rows.row(b), p.rows.row(c);
        if (std::abs(rows.determinant()) < 1e-9) continue;
        const Vector x = rows.inverse() * Eigen::Vector3d(p.bounds[a], p.bounds[b], p.bounds[c]);
        if (inside(p, x)) best = std::min(best, p.gradient.dot(x));
      }
    }
  }
  return best;
}

TEST(ConvexProgram, LinearProgramsEndInTheirBestVertex) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomStream random(seed, 0, RandomStream::Purpose::kTest);
    const ConvexProgram p = random_program(random, 3, 6);
    const ConvexSolution s = solve(p);
    EXPECT_TRUE(s.converged);
    EXPECT_TRUE(inside(p, s.x));
    EXPECT_NEAR(p.gradient.dot(s.x), best_vertex(p), 1e-8);
  }
}

// Karush, Kuhn and Tucker: what is a minimum, whatever found it.
TEST(ConvexProgram, QuadraticProgramsMeetTheConditionsOfAMinimum) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomStream random(seed, 1, RandomStream::Purpose::kTest);
    ConvexProgram p = random_program(random, 6, 8);
    Matrix root(6, 3);  // rank 3: semidefinite
    for (Eigen::Index i = 0; i < root.size(); ++i) root(i) = random.uniform(-1, 1);
    p.hessian = root * root.transpose();
    const ConvexSolution s = solve(p);
    ASSERT_TRUE(s.converged);
    EXPECT_TRUE(inside(p, s.x));
    EXPECT_GE(s.multipliers.minCoeff(), 0);
    const Vector stationarity = p.hessian * s.x + p.gradient + p.rows.transpose() * s.multipliers;
    EXPECT_LT(stationarity.cwiseAbs().maxCoeff(), 1e-7);
    const Vector slack = p.bounds - p.rows * s.x;
    EXPECT_LT(slack.cwiseProduct(s.multipliers).cwiseAbs().maxCoeff(), 1e-7);
  }
}

// x <= -1 and x >= 1 contradict each other by 2: each gives way by 1.
TEST(ConvexProgram, ElasticRowsShareWhatCannotBeMet) {
  ConvexProgram p;
  p.hessian = Matrix::Zero(1, 1);
  p.gradient = Vector::Zero(1);
  p.rows = Matrix(4, 1);
  p.rows << 1, -1, 1, -1;
  p.bounds = Vector(4);
  p.bounds << -1, -1, 5, 5;
  p.elastic = 2;
  p.penalty = 10;
  const ConvexSolution s = solve(p);
  EXPECT_TRUE(s.converged);
  EXPECT_NEAR(s.excess, 1, 1e-8);
  EXPECT_NEAR(s.x[0], 0, 1e-8);
}

}  // namespace
}  // namespace emax
