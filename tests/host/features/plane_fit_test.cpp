#include "host/features/plane_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <numeric>

#include "tests/host/features/clouds.h"

namespace emax::test {
namespace {

std::vector<std::uint32_t> all_of(const std::vector<Point>& cloud) {
  std::vector<std::uint32_t> members(cloud.size());
  std::iota(members.begin(), members.end(), 0u);
  return members;
}

// The twin: the right singular vector of the centred points with the least singular value.
FittedPlane by_svd(const std::vector<Point>& cloud) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(cloud.size()), 3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = cloud[i].transpose();
  }
  FittedPlane fitted;
  fitted.centre = rows.colwise().mean().transpose();
  rows.rowwise() -= fitted.centre.transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  const Point normal = canonical_sign(svd.matrixV().col(2));
  fitted.plane = {normal, normal.dot(fitted.centre)};
  fitted.rms = svd.singularValues()[2] / std::sqrt(static_cast<double>(cloud.size()));
  return fitted;
}

TEST(PlaneFit, IsThatOfTheSingularValueDecomposition) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(named_seed("plane fit", seed));
    const Patch patch = {random.point(-5, 5), random.point(-3, 3), random.point(-3, 3)};
    std::vector<Point> cloud;
    scan_patch(patch, 5 + random.below(500), 0.01, random, cloud);
    const FittedPlane fitted = fit_plane(cloud, all_of(cloud)), twin = by_svd(cloud);
    EXPECT_LT((fitted.plane.normal - twin.plane.normal).norm(), 1e-9) << "seed " << seed;
    EXPECT_NEAR(fitted.plane.offset, twin.plane.offset, 1e-9) << "seed " << seed;
    EXPECT_NEAR(fitted.rms, twin.rms, 1e-10) << "seed " << seed;
    PlaneSums sums;
    for (const Point& p : cloud) sums.add(p);
    EXPECT_LT((sums.plane().normal - twin.plane.normal).norm(), 1e-6) << "seed " << seed;
  }
}

// A twentieth of the points lies on another surface that the band cuts.
TEST(PlaneFit, RobustlyKeepsToMostPoints) {
  Random random(named_seed("plane fit", 1));
  const Patch patch = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Point> cloud;
  scan_patch(patch, 2000, 0.001, random, cloud);
  scan_patch({{0, 0, 0.003}, {0.05, 0, 0.01}, {0, 1, 0}}, 100, 0.001, random, cloud);
  const auto members = all_of(cloud);
  const Plane plain = fit_plane(cloud, members).plane;
  const Plane robust = fit_plane_robustly(cloud, members, plain).plane;
  const auto tilt = [](const Plane& p) { return std::acos(p.normal.z()); };
  EXPECT_LT(tilt(robust), 2e-4);
  EXPECT_GT(tilt(plain), 3 * tilt(robust));
}

TEST(PlaneFit, TellsHowFarASurfaceTurns) {
  Random random(named_seed("turning", 1));
  for (const double angle : {0.1, 0.3}) {
    std::vector<Point> cloud;
    scan_cylinder({{0, 0, 0}, {0, 0, 1}, 2}, 1, angle, 4000, 0.001, random, cloud);
    const Turning turns = turning(cloud, all_of(cloud), fit_plane(cloud, all_of(cloud)));
    EXPECT_NEAR(turns.angle, angle, 0.05 * angle);
    EXPECT_LT(turns.error, 0.05 * angle);
  }
  std::vector<Point> flat;
  scan_patch({{0, 0, 0}, {1, 0, 0}, {0, 0.3, 0}}, 4000, 0.001, random, flat);
  const Turning turns = turning(flat, all_of(flat), fit_plane(flat, all_of(flat)));
  EXPECT_LT(turns.angle, 4 * turns.error);
}

}  // namespace
}  // namespace emax::test
