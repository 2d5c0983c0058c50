#include <emax/genocop.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace emax {
namespace {

Problem disc() {
  Problem problem;
  problem.genes = {{.name = "x", .lower = -5, .upper = 5}, {.name = "y", .lower = -5, .upper = 5}};
  problem.nonlinear = {{}};
  return problem;
}

// The nearest point to (2, 3) of the unit disc.
Evaluation nearest(const Genes& g) {
  return make_evaluation({{}}, std::hypot(g[0] - 2, g[1] - 3), {std::hypot(g[0], g[1]) - 1});
}

TEST(Minimize, FindsAConstrainedMinimum) {
  const Minimum found = minimize(disc(), nearest, {.budget = 300, .seed = 4});
  EXPECT_TRUE(found.evaluation.feasible());
  EXPECT_NEAR(found.evaluation.objective, std::sqrt(13.0) - 1, 1e-3);
  EXPECT_LE(found.evaluations, 300u);
}

TEST(Minimize, GivesTheSameForAnyNumberOfJobs) {
  const Minimum one = minimize(disc(), nearest, {.budget = 120, .seed = 5});
  for (const std::size_t jobs : {2, 5, 16}) {
    const Minimum many = minimize(disc(), nearest, {.budget = 120, .seed = 5, .jobs = jobs});
    EXPECT_EQ(many.genes, one.genes) << jobs;
    EXPECT_EQ(many.evaluations, one.evaluations) << jobs;
  }
  EXPECT_NE(minimize(disc(), nearest, {.budget = 120, .seed = 6}).genes, one.genes);
}

TEST(Minimize, GoesOnAfterEvaluationsThatFail) {
  int asked = 0;
  const Minimum found =
      minimize(disc(), [&](const Genes& g) { return ++asked % 3 == 0 ? Evaluation{} : nearest(g); },
               {.budget = 200, .seed = 7});
  EXPECT_TRUE(found.evaluation.feasible());
}

TEST(Minimize, EndsWithWhatTheCallerThrows) {
  for (const std::size_t jobs : {1, 4}) {
    EXPECT_THROW(
        minimize(disc(), [](const Genes&) -> Evaluation { throw std::range_error("mine"); },
                 {.budget = 50, .jobs = jobs}),
        std::range_error);
  }
}

TEST(Minimize, EndsWhereItIsAskedTo) {
  int polls = 0;
  const Minimum found =
      minimize(disc(), nearest, {.budget = 100000, .interrupted = [&] { return ++polls > 60; }});
  EXPECT_LE(found.evaluations, 60u);
  EXPECT_GT(found.evaluations, 0u);
}

TEST(Minimize, RefusesWhatIsNoProblem) {
  EXPECT_THROW(minimize({}, nearest), Error);
  EXPECT_THROW(minimize(disc(), nearest, {.budget = 0}), Error);
  EXPECT_THROW(minimize(disc(), nearest, {.jobs = 0}), Error);
  EXPECT_THROW(minimize(disc(), nearest, {.jobs = 17}), Error);
  Problem empty = disc();
  empty.genes[0].upper = -6;
  EXPECT_THROW(minimize(empty, nearest), Error);
  EXPECT_THROW(make_evaluation({{}}, 1, {}), Error);
}

}  // namespace
}  // namespace emax
