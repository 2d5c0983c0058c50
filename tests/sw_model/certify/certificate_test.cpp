#include "sw_model/certify/certificate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/support/long_double_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

// Every pair, nothing skipped.
struct BruteForce {
  std::vector<double> upper;
  double e_max = 0;  // in long double, rounded
  double reach = 0;  // the greatest |V - P|: what rounding is relative to

  explicit BruteForce(const test::Stimulus& s) {
    for (const Point& p : s.cloud) {
      double least = INFINITY;
      long double exact = INFINITY;
      for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        least = std::min(least, point_triangle_distance(p, s.mesh().corners(t)).upper);
        exact = std::min(exact, test::long_double_distance(p, s.mesh().corners(t)));
        for (const Point& v : s.mesh().corners(t)) reach = std::max(reach, (v - p).norm());
      }
      upper.push_back(least);
      e_max = std::max(e_max, static_cast<double>(exact));
    }
  }
};

TEST(Certificate, EqualsBruteForceAndTheLowestWorstPoint) {
  for (const test::Stimulus& s : test::all_stimuli(71)) {
    SCOPED_TRACE(s.name + ", seed 71");
    const BruteForce brute(s);
    const CertifiedError certified = certify(s.cloud, s.mesh());
    const auto worst = std::max_element(brute.upper.begin(), brute.upper.end());
    EXPECT_EQ(certified.e_max_upper, *worst);
    EXPECT_EQ(certified.worst_point, static_cast<std::size_t>(worst - brute.upper.begin()));
    EXPECT_EQ(certified.points, s.cloud.size());
    EXPECT_EQ(certified.e_max_upper_all, certified.e_max_upper);
    // The interval holds the exact value, and it is narrow.
    EXPECT_LE(certified.e_max_lower, brute.e_max);
    EXPECT_GE(certified.e_max_upper, brute.e_max);
    EXPECT_LE(certified.e_max_upper, brute.e_max + 32 * 0x1p-53 * brute.reach);
    EXPECT_GE(certified.e_max_lower,
              brute.e_max - 64 * 0x1p-53 * brute.reach * (brute.reach / brute.e_max));
    EXPECT_TRUE(certified.within(certified.e_max_upper));
    EXPECT_FALSE(certified.within(std::nextafter(certified.e_max_upper, 0)));
  }
}

void expect_equal(const CertifiedError& a, const CertifiedError& b) {
  EXPECT_EQ(a.e_max_upper, b.e_max_upper);
  EXPECT_EQ(a.e_max_lower, b.e_max_lower);
  EXPECT_EQ(a.worst_point, b.worst_point);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.excluded, b.excluded);
  EXPECT_EQ(a.excluded_distances, b.excluded_distances);
  EXPECT_EQ(a.e_max_upper_all, b.e_max_upper_all);
}

TEST(Certificate, PiecesInAnyOrderGiveThatOfTheWhole) {
  for (const test::Stimulus& s : test::all_stimuli(74)) {
    SCOPED_TRACE(s.name + ", seed 74");
    const std::span<const Point> cloud = s.cloud;
    std::vector<std::uint32_t> excluded;
    for (std::uint32_t i = 3; i < cloud.size(); i += 7) excluded.push_back(i);
    const ExactMesh mesh(s.mesh());
    const CertifiedError whole = certify(cloud, mesh, excluded);
    for (const std::size_t size : {std::size_t{1}, std::size_t{10}, cloud.size()}) {
      PiecewiseCertificate pieces(mesh);
      for (std::size_t last = cloud.size(); last > 0;) {  // the last piece first
        const std::size_t first = last - std::min(size, last);
        std::vector<std::uint32_t> of_piece;
        for (const std::uint32_t i : excluded) {
          if (i >= first && i < last) of_piece.push_back(static_cast<std::uint32_t>(i - first));
        }
        pieces.add(cloud.subspan(first, last - first), {static_cast<std::uint32_t>(first)},
                   of_piece);
        last = first;
      }
      expect_equal(pieces.finish(), whole);
    }
  }
}

TEST(Certificate, PartsOfSeveralGiveThatOfTheWhole) {
  for (const test::Stimulus& s : test::all_stimuli(75)) {
    SCOPED_TRACE(s.name + ", seed 75");
    const std::span<const Point> cloud = s.cloud;
    const std::array<std::uint32_t, 2> excluded = {0, 2};
    const ExactMesh mesh(s.mesh());
    PiecewiseCertificate first(mesh), rest(mesh), joined(mesh), empty(mesh);
    first.add(cloud.first(3), {}, excluded);
    rest.add(cloud.subspan(3), {3});
    for (const PiecewiseCertificate* part : {&rest, &empty, &first}) joined.add(part->part());
    expect_equal(joined.finish(), certify(cloud, mesh, excluded));
  }
}

// Where every point's upper end is known, only the lower end is to be found.
TEST(Certificate, KnownDistancesGiveThatOfTheWhole) {
  for (const test::Stimulus& s : test::all_stimuli(76)) {
    SCOPED_TRACE(s.name + ", seed 76");
    const std::span<const Point> cloud = s.cloud;
    const std::array<std::uint32_t, 2> excluded = {0, 2};
    const ExactMesh mesh(s.mesh());
    std::vector<double> uppers;
    for (const Point& p : cloud) uppers.push_back(mesh.distance(p).upper);
    PiecewiseCertificate known;
    known.add_known(cloud.subspan(3), {3}, std::span(uppers).subspan(3));
    known.add_known(cloud.first(3), {}, std::span(uppers).first(3), excluded);
    expect_equal(known.finish([&](const Point& p, double upper) {
      EXPECT_EQ(upper, mesh.distance(p).upper);
      return mesh.distance(p).lower;
    }),
                 certify(cloud, mesh, excluded));
  }
}

// A bumpy sphere and three points far from it.
test::Stimulus with_outliers() {
  test::Stimulus s = test::bumpy_sphere(12, 16, 300, 72);
  s.cloud[17] *= 3;
  s.cloud[200] *= 2;
  s.cloud[5] *= 4;
  return s;
}

TEST(Certificate, LeavesOutExcludedPointsAndNamesTheirDistances) {
  const test::Stimulus s = with_outliers();
  const BruteForce brute(s);
  const std::vector<std::uint32_t> excluded = {200, 5, 17};
  const CertifiedError certified = certify(s.cloud, s.mesh(), excluded);
  EXPECT_EQ(certified.points, s.cloud.size() - 3);
  EXPECT_EQ(certified.excluded, excluded);
  EXPECT_EQ(certified.excluded_distances,
            (std::vector<double>{brute.upper[200], brute.upper[5], brute.upper[17]}));
  EXPECT_EQ(certified.e_max_upper_all, brute.upper[5]);
  double kept = 0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < s.cloud.size(); ++i) {
    if (i == 5 || i == 17 || i == 200 || brute.upper[i] <= kept) continue;
    kept = brute.upper[i];
    worst = i;
  }
  EXPECT_EQ(certified.e_max_upper, kept);
  EXPECT_EQ(certified.worst_point, worst);
  EXPECT_LT(certified.e_max_upper, certified.e_max_upper_all);
}

TEST(Certificate, FindsTheFirstOfManyEqualPoints) {
  test::Stimulus s = test::bumpy_sphere(8, 8, 40, 73);
  s.cloud.insert(s.cloud.end(), s.cloud.begin(), s.cloud.end());
  const CertifiedError once = certify(std::span(s.cloud).first(40), s.mesh());
  const CertifiedError twice = certify(s.cloud, s.mesh());
  EXPECT_EQ(once.worst_point, twice.worst_point);
  EXPECT_EQ(once.e_max_upper, twice.e_max_upper);
}

// Several pieces of the cloud, the worst point in many of them: the lowest index wins.
TEST(Certificate, IsTheSameForAnyNumberOfThreads) {
  const test::Stimulus one = test::bumpy_sphere(9, 11, 700, 76);
  test::Stimulus many = one;
  for (int i = 0; i < 40; ++i) {
    many.cloud.insert(many.cloud.end(), one.cloud.begin(), one.cloud.end());
  }
  std::reverse(many.cloud.begin() + 350, many.cloud.end());
  const BruteForce brute(one);
  const std::vector<std::uint32_t> excluded = {3, 20'000};
  const CertifiedError alone = certify(many.cloud, many.mesh(), excluded);
  EXPECT_EQ(alone.e_max_upper, *std::ranges::max_element(brute.upper));
  const ExactMesh exact(many.mesh());
  std::size_t lowest = 0;
  while (lowest == 3 || exact.distance(many.cloud[lowest]).upper < alone.e_max_upper) ++lowest;
  EXPECT_EQ(alone.worst_point, lowest);
  for (const std::size_t threads : {1, 2, 3, 16}) {
    SCOPED_TRACE(threads);
    const CertifiedError certified = certify(many.cloud, exact, excluded, threads);
    EXPECT_EQ(certified.e_max_upper, alone.e_max_upper);
    EXPECT_EQ(certified.e_max_lower, alone.e_max_lower);
    EXPECT_EQ(certified.worst_point, alone.worst_point);
    EXPECT_EQ(certified.excluded_distances, alone.excluded_distances);
  }
}

TEST(Certificate, IsZeroWhereEveryPointIsAVertex) {
  const test::Stimulus s = test::bumpy_sphere(8, 8, 0, 74);
  const CertifiedError certified = certify(s.vertices, s.mesh());
  EXPECT_EQ(certified.e_max_upper, 0);
  EXPECT_EQ(certified.worst_point, 0u);
  EXPECT_TRUE(certified.within(0));
}

TEST(Certificate, RefusesWhatItCannotCertify) {
  test::Stimulus s = test::bumpy_sphere(8, 8, 4, 75);
  const std::vector<std::uint32_t> all = {0, 1, 2, 3}, twice = {1, 1}, beyond = {4};
  EXPECT_THROW(certify({}, s.mesh()), Error);
  EXPECT_THROW(certify(s.cloud, s.mesh(), all), Error);
  EXPECT_THROW(certify(s.cloud, s.mesh(), twice), std::invalid_argument);
  EXPECT_THROW(certify(s.cloud, s.mesh(), beyond), std::invalid_argument);
  {
    const ScopedFlushMode flush;
    EXPECT_THROW(certify(s.cloud, s.mesh()), std::logic_error);
  }
  for (const double bad : {double(INFINITY), double(NAN)}) {
    s.cloud[2].y() = bad;
    try {
      certify(s.cloud, s.mesh());
      FAIL() << "certified a point with a coordinate of " << bad;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("point 2"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace emax
