#include "tests/benchmarks/bisection/bisection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sw_model/base/error.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/benchmarks/bisection/cloud_error.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using benchmarks::BisectionSettings;
using benchmarks::CloudError;
using benchmarks::Found;
using benchmarks::Trial;

constexpr double kMost = 5000, kLeast = 4;

// A tool whose parameter is how many triangles it leaves.
template <class Error>
Trial toy(double coarseness, Error error) {
  const auto triangles =
      static_cast<std::size_t>(std::round(benchmarks::parameter_at(coarseness, kMost, kLeast)));
  Trial trial{{}, 1, error(static_cast<double>(triangles))};
  trial.mesh.triangles.resize(triangles);
  return trial;
}

template <class Error>
std::size_t fewest_of_all(double limit, Error error) {
  for (double triangles = kLeast; triangles <= kMost; ++triangles) {
    if (error(triangles) <= limit) return static_cast<std::size_t>(triangles);
  }
  return 0;
}

template <class Error>
Found searched(BisectionSettings settings, Error error) {
  return benchmarks::fewest_within([&](double at) { return toy(at, error); }, settings);
}

TEST(Bisection, IsTheScanOfEveryValueWhereErrorsAreMonotone) {
  const auto error = [](double triangles) { return 3 / std::sqrt(triangles); };
  for (const double limit : {1.5, 1.0, 0.3, 0.111, 0.0512, 0.0425}) {
    const Found found = searched({.limit = limit}, error);
    ASSERT_TRUE(found.best) << limit;
    EXPECT_EQ(found.best->mesh.triangles.size(), fewest_of_all(limit, error)) << limit;
    EXPECT_LE(found.best->error, limit);
    EXPECT_LE(found.calls, 35) << limit;
    EXPECT_EQ(found.seconds, found.calls);
    EXPECT_LE(found.least_error, found.best->error);
  }
}

TEST(Bisection, IsNearTheScanOfEveryValueWhereTheyAreNot) {
  const auto error = [](double triangles) {
    return 3 / std::sqrt(triangles) * (1 + 0.1 * std::sin(40 * std::log(triangles)));
  };
  for (const double limit : {1.0, 0.3, 0.2, 0.111, 0.0512}) {
    const Found found = searched({.limit = limit}, error);
    ASSERT_TRUE(found.best) << limit;
    EXPECT_LE(found.best->error, limit);
    const auto fewest = static_cast<double>(fewest_of_all(limit, error));
    EXPECT_LE(static_cast<double>(found.best->mesh.triangles.size()), 1.2 * fewest) << limit;
  }
}

TEST(Bisection, SaysThatNothingPasses) {
  const auto error = [](double triangles) { return 1 + 1 / triangles; };
  const Found found = searched({.limit = 1}, error);
  EXPECT_FALSE(found.best);
  EXPECT_EQ(found.least_error, error(kMost));
  EXPECT_EQ(found.calls, 11);
}

TEST(Bisection, GivesUpWhereItCannotBeatAnother) {
  const auto error = [](double triangles) { return 100 / triangles; };
  const Found found = searched({.limit = 0.1, .beat = 900}, error);
  EXPECT_GT(found.best->mesh.triangles.size(), 900);
  EXPECT_LT(found.calls, searched({.limit = 0.1}, error).calls / 2 + 4);
  const Found better = searched({.limit = 0.1, .beat = 1100}, error);
  EXPECT_EQ(better.best->mesh.triangles.size(), 1000);
}

TEST(Bisection, OneCallShowsThatAnotherIsNoBetter) {
  const auto error = [](double triangles) { return 100 / triangles; };
  BisectionSettings settings{.limit = 0.1, .beat = 900};
  settings.start = benchmarks::coarseness_at(910, kMost, kLeast);
  const Found found = searched(settings, error);
  EXPECT_FALSE(found.best);
  EXPECT_EQ(found.calls, 1);
}

TEST(Bisection, ParametersGoBackAndForth) {
  for (const double parameter : {kMost, 321.0, kLeast}) {
    const double coarseness = benchmarks::coarseness_at(parameter, kMost, kLeast);
    EXPECT_DOUBLE_EQ(benchmarks::parameter_at(coarseness, kMost, kLeast), parameter);
  }
  EXPECT_EQ(benchmarks::coarseness_at(1, kMost, kLeast), 1);
  EXPECT_EQ(benchmarks::coarseness_at(2 * kMost, kMost, kLeast), 0);
}

TEST(Bisection, FindsItsWayFromAnyStart) {
  const auto error = [](double triangles) { return 100 / triangles; };
  for (const double start : {0.0, 0.2, 0.23, 0.5, 0.9, 1.0}) {
    const Found found = searched({.limit = 0.2, .start = start}, error);
    ASSERT_TRUE(found.best) << start;
    EXPECT_EQ(found.best->mesh.triangles.size(), 500) << start;
  }
  EXPECT_EQ(searched({.limit = 1000, .start = 0.5}, error).best->mesh.triangles.size(), kLeast);
}

TEST(CloudErrorTest, IsTheExactOneAndAFaultIsSeen) {
  const Stimulus sphere = bumpy_sphere(20, 40, 3000, 7);
  const TriangleMesh mesh{sphere.vertices, sphere.triangles};
  std::vector<Point> cloud = sphere.cloud;
  cloud.push_back({1.7, 0.2, 0.1});  // the worst, in the half that the fault skips
  const ExactMesh exact(mesh.view());
  double worst = 0;
  for (const Point& p : cloud) worst = std::max(worst, exact.distance(p).upper);

  CloudError error(cloud);
  EXPECT_NO_THROW(error.confirm("toy", error(mesh), worst));
  CloudError blind(cloud, CloudError::Fault::kSkipsPoints);
  EXPECT_THROW(blind.confirm("toy", blind(mesh), worst), Error);
}

TEST(CloudErrorTest, IsInfiniteWhereThereIsNothingToMeasure) {
  const std::vector<Point> cloud = {{0, 0, 0}, {1, 1, 1}};
  CloudError error(cloud);
  EXPECT_EQ(error({}), std::numeric_limits<double>::infinity());
  const TriangleMesh broken{{{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}}, {{0, 1, 2}}};
  EXPECT_EQ(error(broken), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace emax::test
