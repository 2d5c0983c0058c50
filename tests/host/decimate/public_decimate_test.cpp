#include <emax/certify.h>
#include <emax/check.h>
#include <emax/decimate.h>
#include <gtest/gtest.h>

#include "sw_model/base/public_arguments.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

TEST(PublicDecimate, GivesASurfaceThatAnyoneCanProve) {
  for (const TriangleMesh& mesh : {bumpy(24, 40), sheet(24, 0.3), cube(6)}) {
    const Surface given = as_public(mesh.view());
    const Decimation made = decimate(given, {.max_error = 0.02});
    EXPECT_LT(made.surface.indices.size(), given.indices.size() / 2);
    EXPECT_TRUE(check_surface(made.surface).valid());
    EXPECT_LE(certify_points(given.coordinates, made.surface).upper, 0.02);
    EXPECT_TRUE(certify_within(made.surface, given, 0.02));
    EXPECT_TRUE(certify_within(given, made.surface, 0.02));
    EXPECT_LE(made.e_max, 0.02);
    EXPECT_LE(*made.to_reference, 0.02);
    EXPECT_LE(*made.from_reference, 0.02);
  }
  // What is claimed can be wrong.
  const Surface given = as_public(bumpy(24, 40).view());
  EXPECT_FALSE(certify_within(decimate(given, {.max_error = 0.02}).surface, given, 1e-4));
}

TEST(PublicDecimate, HoldsTheCloudThatIsGiven) {
  const TriangleMesh mesh = bumpy(24, 40);
  std::vector<double> cloud;
  for (const Point& p : mesh.vertices) {
    for (int k = 0; k < 3; ++k) cloud.push_back(1.015 * p[k]);
  }
  const Decimation made = decimate(as_public(mesh.view()), cloud, {.max_error = 0.02});
  EXPECT_LE(certify_points(cloud, made.surface).upper, 0.02);
  EXPECT_TRUE(made.left_out.empty());
}

TEST(PublicDecimate, EndsWhereItIsAskedToWithItsBounds) {
  const Surface given = as_public(bumpy(30, 50).view());
  int polls = 0;
  DecimateOptions options = {.max_error = 0.02};
  options.interrupted = [&] { return ++polls > 20; };
  const Decimation made = decimate(given, options);
  EXPECT_TRUE(made.interrupted);
  EXPECT_LE(certify_points(given.coordinates, made.surface).upper, 0.02);
}

TEST(PublicDecimate, RefusesBoundsThatAreNone) {
  const Surface given = as_public(bumpy(6, 8).view());
  for (const double none : {0.0, -1.0, std::nan(""), 1e-300}) {
    EXPECT_THROW(decimate(given, {.max_error = none}), Error) << none;
  }
  EXPECT_THROW(decimate(given, {.max_error = 0.1, .max_back_error = -1}), Error);
  EXPECT_THROW(decimate(given, std::vector<double>{1, 2}, {.max_error = 0.1}), Error);
  EXPECT_THROW(decimate({}, {.max_error = 0.1}), Error);
}

}  // namespace
}  // namespace emax::test
