#include "host/measure/error_constraint.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/block_search/simd_evaluator.h"
#include "sw_model/certify/certificate.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

MeasuredError measure(const test::Stimulus& s, double epsilon, double share,
                      bool brute_force = false) {
  ErrorConstraint constraint(s.cloud, epsilon, share, brute_force);
  const MeasuredError measured = constraint.measure(s.mesh());
  SimdEvaluator blocks;
  EXPECT_EQ(constraint.measure(s.mesh(), blocks), measured);
  return measured;
}

TEST(ErrorConstraint, FeasibleMeansThatTheCertificateAgrees) {
  for (std::uint64_t seed = 90; seed < 93; ++seed) {
    for (const test::Stimulus& s : test::all_stimuli(seed)) {
      SCOPED_TRACE(s.name + ", seed " + std::to_string(seed));
      const double e_max = certify(s.cloud, s.mesh()).e_max_upper;
      for (const double factor : {0.5, 0.99, 1 - 1e-6, 1.0, 1 + 1e-6, 1.01, 2.0}) {
        const MeasuredError measured = measure(s, factor * e_max, 0);
        if (measured.feasible) {
          EXPECT_GE(factor, 1);
        }
        EXPECT_EQ(measured.feasible, measured.violation <= 0);
      }
      // Triangles far larger than the cloud cost the kernel its accuracy, and so feasibility.
      if (s.name == "huge triangles" || s.name == "triangles a million sizes away") continue;
      EXPECT_TRUE(measure(s, 1.01 * e_max, 0).feasible);
    }
  }
}

TEST(ErrorConstraint, ViolationGrowsAsTheToleranceShrinks) {
  const test::Stimulus s = test::bumpy_sphere(10, 12, 800, 94);
  const double e_max = certify(s.cloud, s.mesh()).e_max_upper;
  double last = -1;
  for (const double factor : {1.5, 1.1, 0.9, 0.5, 0.1, 1e-9}) {
    const double violation = measure(s, factor * e_max, 0).violation;
    EXPECT_GT(violation, last) << factor;
    last = violation;
  }
}

TEST(ErrorConstraint, ExcludesTheFarthestPointsBeyondTheToleranceOnly) {
  const test::Stimulus s = test::bumpy_sphere(8, 10, 1000, 95);
  SimdEvaluator cpu;
  const PreparedCloud cloud(s.cloud);
  const auto bits = search_nearest(cloud, TriangleTree(s.mesh(), cloud.normalization()), cpu);
  std::vector<std::uint32_t> sorted = bits;
  std::ranges::sort(sorted, std::greater{});

  // Twenty may go; a tolerance that all but ten keep excludes those ten.
  const double tenth = ErrorConstraint(s.cloud, 1, 0).in_file_units(sorted[9]);
  const double eleventh = ErrorConstraint(s.cloud, 1, 0).in_file_units(sorted[10]);
  for (const bool brute_force : {false, true}) {
    const MeasuredError measured = measure(s, (tenth + eleventh) / 2, 0.02, brute_force);
    EXPECT_TRUE(measured.feasible);
    ASSERT_EQ(measured.excluded.size(), 10u);
    EXPECT_TRUE(std::ranges::is_sorted(measured.excluded));
    for (const std::uint32_t i : measured.excluded) EXPECT_GE(bits[i], sorted[9]);
    EXPECT_EQ(measured.kept.squared_bits, sorted[10]);
    EXPECT_EQ(bits[measured.kept.worst_point], sorted[10]);
    EXPECT_EQ(measured.all, worst_of(bits));
  }
  // Five may go: not enough.
  const MeasuredError few = measure(s, (tenth + eleventh) / 2, 0.005);
  EXPECT_FALSE(few.feasible);
  EXPECT_EQ(few.excluded.size(), 5u);
  EXPECT_EQ(few.kept.squared_bits, sorted[5]);
}

TEST(ErrorConstraint, OfEqualPointsTheLowestIndexIsTheWorst) {
  const test::Stimulus s = test::named_stimulus("level ties", 96);
  EXPECT_EQ(measure(s, 2, 0.1).kept.worst_point, 0u);
  EXPECT_EQ(measure(s, 0.5, 0.1).kept.worst_point, 0u) << "the higher indices are excluded first";
  EXPECT_EQ(measure(s, 0.5, 0.1).excluded.size(), 400u);
}

TEST(ErrorConstraint, SharesArePointsAsOneCountsThem) {
  for (const std::size_t permille : {7, 14, 28, 29, 41}) {
    EXPECT_EQ(excludable_points(static_cast<double>(permille) / 10 / 100, 1000), permille);
  }
  EXPECT_EQ(excludable_points(0.0069999, 1000), 6u);
  EXPECT_EQ(excludable_points(0, 1000), 0u);
}

}  // namespace
}  // namespace emax
