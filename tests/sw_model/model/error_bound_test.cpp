#include "sw_model/model/error_bound.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>

#include "hls/kernel/point_triangle.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "tests/support/adversarial_pairs.h"
#include "tests/support/long_double_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using test::Family, test::Pair, test::families, test::kernel_point, test::log_uniform;
using test::neighbour, test::random_pair, test::to_binary32;

constexpr double kUnit = 0x1p-24;

using Kernel = std::function<double(const Vector3<float>&, const TriangleRecord<float>&)>;

double kernel_distance(const Vector3<float>& p, const TriangleRecord<float>& record) {
  return std::sqrt(static_cast<double>(bits_float(pair_squared_bits(p, record))));
}

// Right in exact arithmetic, wrong on slivers: the visible edge with the most negative h.
double most_negative_across(const Vector3<float>& p, const TriangleRecord<float>& record) {
  const Vector3<float> frame = to_frame(record, p);
  const TriangleView<float> view = view_edges(record, frame.y, frame.z);
  EdgeView<float> chosen = {0, 0, 0};
  for (const EdgeView<float>& edge : {view.edge12, view.edge13, view.edge23}) {
    const bool is_first = &edge == &view.edge12;
    if ((record.tag & kSegmentFlag) != 0 && !is_first) continue;
    if (edge.across < chosen.across) chosen = edge;
  }
  if ((record.tag & kSegmentFlag) != 0) chosen = view.edge12;
  return std::sqrt(static_cast<double>(
      frame.x * frame.x + (chosen.across * chosen.across + chosen.residual * chosen.residual)));
}

struct Measured {
  double error = 0;  // |d_k - d|
  double size = 0;   // |P - V1| + L1 + |V1|
  double signed_error = 0;
  double true_distance = 0;
  bool segment = false;
};

Measured measure(const Kernel& kernel, const Pair& pair) {
  const TriangleFrame frame = make_frame(pair.corners);
  const double computed = kernel(kernel_point(pair.p), make_record(frame, 0));
  const long double exact = test::long_double_distance(pair.p, pair.corners);
  const double difference = static_cast<double>(computed - exact);
  return {std::abs(difference),
          (pair.p - eigen(frame.record.v1)).norm() + frame.record.length12 +
              eigen(frame.record.v1).norm(),
          difference, static_cast<double>(exact), frame.segment};
}

double ratio(const Measured& m) { return (m.error - kDistanceFloor) / m.size; }

struct Worst {
  double ratio = 0;
  bool segment = false;
};

Worst random_search(const Kernel& kernel, const Family& family, std::uint64_t seed, int pairs) {
  test::Random random(seed);
  Worst worst;
  for (int i = 0; i < pairs; ++i) {
    const Measured m = measure(kernel, random_pair(random, family));
    if (ratio(m) > worst.ratio) worst = {ratio(m), m.segment};
  }
  return worst;
}

// Climbs from random pairs towards a counterexample.
Worst hill_climb(const Kernel& kernel, const Family& family, std::uint64_t seed, int starts,
                 int steps) {
  test::Random random(seed);
  Worst worst;
  for (int start = 0; start < starts; ++start) {
    Pair pair = random_pair(random, family);
    double height = ratio(measure(kernel, pair));
    for (int step = 0; step < steps; ++step) {
      const Pair next = neighbour(random, pair);
      const Measured m = measure(kernel, next);
      if (ratio(m) > height) {
        pair = next;
        height = ratio(m);
        if (height > worst.ratio) worst = {height, m.segment};
      }
    }
  }
  return worst;
}

TEST(ErrorBound, HoldsForEveryFamilyAndForClimbersTowardsACounterexample) {
  double greatest = 0, greatest_triangle = 0;
  std::uint64_t seed = 1000;
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
    const Worst random = random_search(kernel_distance, family, seed, 60000);
    const Worst climbed = hill_climb(kernel_distance, family, seed + 1, 100, 400);
    seed += 2;
    std::printf("%-24s random %.3g, climbed %.3g%s\n", family.name.c_str(), random.ratio,
                climbed.ratio, climbed.segment ? " (segment)" : "");
    for (const Worst& worst : {random, climbed}) {
      EXPECT_GT(worst.ratio, 0) << "nothing was measured";
      EXPECT_LE(worst.ratio, kKappa);
      greatest = std::max(greatest, worst.ratio);
      if (!worst.segment) greatest_triangle = std::max(greatest_triangle, worst.ratio);
    }
  }
  RecordProperty("greatest", std::to_string(greatest));
  std::printf("greatest |d_k - d| / (|P - V1| + L1 + |V1|): %.3g, of triangles %.3g; kappa %.3g\n",
              greatest, greatest_triangle, kKappa);
  EXPECT_LE(greatest_triangle, 27 * kUnit) << "more than docs/numerics.md proves";
}

TEST(ErrorBound, IsBrokenByChoosingTheMostNegativeEdge) {
  const Family& slivers = families()[1];
  const Worst worst = random_search(most_negative_across, slivers, 7, 60000);
  std::printf("most negative h on slivers, seed 7: %.3g\n", worst.ratio);
  EXPECT_GT(worst.ratio, 2 * kKappa);
}

// A cluster of pairs so close together that only what squaring flushes is left of their distance.
TEST(ErrorBound, NeedsItsFloorWhereSquaresFlush) {
  test::Random random(11);
  double greatest = 0;
  for (int i = 0; i < 20000; ++i) {
    Pair pair;
    const double scale = std::ldexp(1.0, -55 - static_cast<int>(random.below(90)));
    for (Point& corner : pair.corners) corner = scale * random.point(-1, 1);
    pair.p = to_binary32(scale * random.point(-2, 2));
    const Measured m = measure(kernel_distance, pair);
    ASSERT_LE(m.error, kKappa * m.size + kDistanceFloor) << "seed 11, pair " << i;
    greatest = std::max(greatest, m.error - kKappa * m.size);
  }
  EXPECT_GT(greatest, kDistanceFloor / 4);
}

// docs/numerics.md, "What is assumed of a record": binary64 leaves every field within 2^-28.
TEST(ErrorBound, StandsOnFramesThatAreExactToTwoToTheMinus28) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  double greatest = 0;
  std::uint64_t seed = 2000;
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
    test::Random random(seed++);
    for (int i = 0; i < 20000; ++i) {
      const std::array<Point, 3> corners = random_pair(random, family).corners;
      const TriangleFrame frame = make_frame(corners);
      if (frame.segment) continue;
      const std::size_t first = static_cast<std::size_t>(
          std::find(corners.begin(), corners.end(), eigen(frame.record.v1)) - corners.begin());
      ASSERT_LT(first, 3u);
      const Vector v1 = corners[first].cast<long double>();
      const Vector edge12 = corners[(first + 1) % 3].cast<long double>() - v1;
      const Vector edge13 = corners[(first + 2) % 3].cast<long double>() - v1;
      const Vector edge23 = edge13 - edge12;
      const Vector along = edge12.normalized();
      Vector in_plane = (edge13 - edge13.dot(along) * along).normalized();
      in_plane = (in_plane - in_plane.dot(along) * along).normalized();
      const Vector normal = in_plane.cross(along);
      const auto off = [&greatest](long double got, long double exact, long double unit) {
        const double error = static_cast<double>(std::abs(got - exact) / unit);
        greatest = std::max(greatest, error);
        return error;
      };
      constexpr double kAllowed = 0x1p-28;
      for (Eigen::Index k = 0; k < 3; ++k) {
        ASSERT_LE(off(eigen(frame.record.along)[k], along[k], 1), kAllowed);
        ASSERT_LE(off(eigen(frame.record.in_plane)[k], in_plane[k], 1), kAllowed);
        ASSERT_LE(off(eigen(frame.record.normal)[k], normal[k], 1), kAllowed);
      }
      const long double l12 = edge12.norm(), l13 = edge13.norm(), l23 = edge23.norm();
      ASSERT_LE(off(frame.record.length12, l12, l12), kAllowed);
      ASSERT_LE(off(frame.record.edge13.length, l13, l13), kAllowed);
      ASSERT_LE(off(frame.record.edge23.length, l23, l23), kAllowed);
      const long double e2y = edge13.dot(in_plane) / l13, e3y = edge23.dot(in_plane) / l23;
      ASSERT_LE(off(frame.record.edge13.direction.y, e2y, e2y), kAllowed) << i;
      ASSERT_LE(off(frame.record.edge23.direction.y, e3y, e3y), kAllowed) << i;
      ASSERT_LE(off(frame.record.edge13.direction.z, edge13.dot(along) / l13, 1), kAllowed);
      ASSERT_LE(off(frame.record.edge23.direction.z, edge23.dot(along) / l23, 1), kAllowed);
      ASSERT_GT(frame.record.edge13.direction.z, 0);
      ASSERT_LT(frame.record.edge23.direction.z, 0);
    }
  }
  std::printf("frames: greatest error %.3g, allowed %.3g\n", greatest, 0x1p-28);
}

// What a search may skip: the margin of the search keeps every kernel distance above the bound.
TEST(DistanceMargin, CoversTheKernelAndNothingLessDoes) {
  test::Random random(21);
  int below_the_true_distance = 0;
  for (int i = 0; i < 60000; ++i) {
    const Pair pair = random_pair(random, families()[random.below(7)]);
    const TriangleFrame frame = make_frame(pair.corners);
    const double bound = static_cast<double>(test::long_double_distance(pair.p, pair.corners));
    const double kernel = kernel_distance(kernel_point(pair.p), make_record(frame, 0));
    const double margin =
        kernel_distance_margin(bound, frame.record.length12, eigen(frame.record.v1).norm());
    ASSERT_GE(kernel, bound - margin) << "seed 21, pair " << i;
    below_the_true_distance += kernel < bound ? 1 : 0;
  }
  EXPECT_GT(below_the_true_distance, 1000) << "without a margin these would have been lost";
}

TEST(LargestFeasibleBits, IsTheGreatestThatTheBoundAllows) {
  test::Random random(31);
  for (int i = 0; i < 20000; ++i) {
    const double epsilon = log_uniform(random, -5, 1), reach = epsilon + random.uniform(0, 4);
    const auto bits = largest_feasible_bits(epsilon, reach);
    ASSERT_TRUE(bits.has_value() || epsilon < kKappa * reach + kDistanceFloor);
    if (!bits) continue;
    const auto implied = [reach](std::uint32_t b) {
      return std::sqrt(static_cast<long double>(bits_float(b))) + kKappa * reach + kDistanceFloor;
    };
    ASSERT_LE(implied(*bits), epsilon * (1 + 0x1p-50L)) << "seed 31, " << i;
    ASSERT_GT(implied(*bits + 1), epsilon * (1 - 0x1p-50L)) << "seed 31, " << i;
  }
}

TEST(LargestFeasibleBits, CostsLittleAtTheUsualEpsilon) {
  const auto bits = largest_feasible_bits(0.003, 0.003 + 2 * 0.05 + 1.7321);
  ASSERT_TRUE(bits.has_value());
  EXPECT_GT(std::sqrt(bits_float(*bits)), 0.003 * 0.998);
}

TEST(LargestFeasibleBits, ProvesNothingBelowTheKernelsError) {
  EXPECT_EQ(largest_feasible_bits(kKappa, 2), std::nullopt);
  EXPECT_EQ(largest_feasible_bits(std::nan(""), 2), std::nullopt);
  EXPECT_EQ(largest_feasible_bits(2 * kKappa + kDistanceFloor, 2), 0u);
  EXPECT_EQ(largest_feasible_bits(1e30, 2), float_bits(std::numeric_limits<float>::max()));
}

// From file units to the kernel and back: what the threshold accepts, the certificate confirms.
TEST(LargestFeasibleBits, AcceptsOnlyWhatTheCertificateConfirms) {
  int accepted = 0;
  for (const test::Stimulus& s : test::all_stimuli(41)) {
    SCOPED_TRACE(s.name + ", seed 41");
    const Normalization normalization = normalization_of(s.cloud);
    const EmaxResult kernel = emax_model(normalized_points(s.cloud, normalization),
                                         make_records(s.mesh(), normalization));
    const double certified = certify(s.cloud, s.mesh()).e_max_upper;
    double longest = 0, farthest = 0;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
      const std::array<Point, 3> v = s.mesh().corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        longest = std::max(longest, normalization.length((v[(k + 1) % 3] - v[k]).norm()));
        farthest = std::max(farthest, normalization.apply(v[k]).norm());
      }
    }
    for (const double share : {0.5, 0.999999, 1.0, 1.0001, 1.1, 2.0}) {
      const double epsilon = share * certified;
      const double normalised = normalization.length(epsilon);
      const auto bits = largest_feasible_bits(normalised, normalised + 2 * longest + farthest);
      if (!bits || kernel.squared_bits > *bits) continue;
      EXPECT_LE(certified, epsilon) << "share " << share;
      ++accepted;
    }
  }
  EXPECT_GT(accepted, 10);
}

}  // namespace
}  // namespace emax
