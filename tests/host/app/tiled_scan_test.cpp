#include "host/app/tiled_scan.h"

#include <gtest/gtest.h>

#include <random>

#include "host/app/proven_decimation.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/messages.h"

namespace emax {
namespace {

constexpr double kTolerance = 0.02;

// A sheet of large triangles, points scattered over it, and some far above it.
struct SpikedSheet {
  TriangleMesh mesh = test::sheet(9, 0.1);
  Scan scan;

  // One of so many points is a spike.
  explicit SpikedSheet(int of) {
    std::mt19937_64 generator(3);
    std::uniform_real_distribution<double> weight(0, 1), above(0.03, 0.12);
    std::vector<Point>& points = scan.cloud.points;
    for (int i = 0; i < 20000; ++i) {
      const std::size_t t = generator() % mesh.triangles.size();
      const auto [a, b, c] = mesh.view().corners(t);
      const double u = weight(generator), v = weight(generator) * (1 - u);
      const double height = i % of == 0 ? above(generator) : 0.002 * weight(generator);
      points.push_back(a + u * (b - a) + v * (c - a) + Point(0, 0, height));
    }
    scan.width = bounds_of(points).width();
  }
};

TiledScanSettings settings() {
  TiledScanSettings settings;
  settings.epsilon = kTolerance;
  settings.far = 0.9 * kTolerance;
  settings.memory = 1 << 20;
  settings.triangles_of_a_tile = 1000;
  return settings;
}

// How many points the joining of others moved the reference away from, and how many it joined.
std::pair<std::size_t, std::size_t> lost_and_joined() {
  const SpikedSheet sheet(400);
  const ScanPieces pieces(sheet.scan);
  TiledScan tiled(pieces, sheet.mesh, settings());
  const GivenReference made = tiled.make_reference({});
  const ExactMesh before(sheet.mesh.view()), after(made.surface.mesh.view());
  const auto lost = std::ranges::count_if(sheet.scan.cloud.points, [&](const Point& p) {
    return before.distance(p).upper <= settings().far && after.distance(p).upper > settings().far;
  });
  return {static_cast<std::size_t>(lost), made.surface.inserted};
}

TEST(TiledScan, JoinsFarPointsWithoutLosingOthers) {
  const auto [lost, joined] = lost_and_joined();
  EXPECT_EQ(lost, 0u);
  EXPECT_GT(joined, 10u);
}

TEST(TiledScanFault, LostPointsAreNoticed) {
  const DeliberateFault fault(Fault::kTrustsJoined);
  EXPECT_GT(lost_and_joined().first, 0u);
}

TEST(TiledScan, ExcludesTheFarthestPoints) {
  const SpikedSheet sheet(2500);
  const ScanPieces pieces(sheet.scan);
  TiledScanSettings wanted = settings();
  wanted.excludable = 8;  // all spikes
  LocalTiles local;
  wanted.runner = &local;
  TiledScan tiled(pieces, sheet.mesh, wanted);
  const GivenReference made = tiled.make_reference({});
  CertifiedDecimationSettings bounds;
  bounds.decimation.epsilon = kTolerance;
  bounds.decimation.effort = DecimationSettings::Effort::kCollapse;
  const CertifiedDecimation result = tiled.decimate(made.surface.mesh, bounds);
  // One by one.
  std::vector<std::pair<double, std::uint32_t>> distances;
  const ExactMesh given(sheet.mesh.view());
  for (std::uint32_t i = 0; i < sheet.scan.cloud.points.size(); ++i) {
    distances.emplace_back(-given.distance(sheet.scan.cloud.points[i]).upper, i);
  }
  std::ranges::sort(distances);
  std::vector<std::uint32_t> farthest;
  for (std::size_t i = 0; i < 8; ++i) farthest.push_back(distances[i].second);
  std::ranges::sort(farthest);
  EXPECT_EQ(result.points.excluded, farthest);
  EXPECT_TRUE(certify(sheet.scan.cloud.points, result.mesh.view(), farthest).within(kTolerance));
  const ProvenMesh proven = tiled.prove(result, &made.surface.mesh);
  EXPECT_EQ(proven.points.e_max_upper, result.points.e_max_upper);
  EXPECT_EQ(proven.kernel.worst_point,
            kernel_error(sheet.scan, result.mesh.view(), farthest).worst_point);
  EXPECT_EQ(*proven.points_to_reference,
            certify(sheet.scan.cloud.points, made.surface.mesh.view(), farthest).e_max_upper);
}

// Of the spikes that may be excluded, the lowest can be joined in place of some that cannot.
TEST(TiledScan, ExcludesWhatCannotBeJoined) {
  SpikedSheet sheet(2500);
  std::vector<Point>& points = sheet.scan.cloud.points;
  for (int i = 0; i < 3; ++i) points.push_back({0.5, 0.5, 0.5 + 0.1 * i});  // one over the other
  const ScanPieces pieces(sheet.scan);
  TiledScanSettings wanted = settings();
  wanted.excludable = 8;
  TiledScan tiled(pieces, sheet.mesh, wanted);
  const GivenReference made = tiled.make_reference({});
  const ExactMesh reference(made.surface.mesh.view());
  const auto beyond = std::ranges::count_if(
      points, [&](const Point& p) { return reference.distance(p).upper > kTolerance; });
  EXPECT_LE(beyond, 8);
}

TEST(ReferenceWithRoom, ExcludesWhatCannotBeJoined) {
  SpikedSheet sheet(2500);
  std::vector<Point>& points = sheet.scan.cloud.points;
  for (int i = 0; i < 3; ++i) points.push_back({0.5, 0.5, 0.5 + 0.1 * i});
  std::vector<std::size_t> excluded;
  const KeptReference made = reference_with_room(
      sheet.scan, sheet.mesh.view(), kTolerance, 8, 1, [&](const KeptPoints& kept) {
        excluded.push_back(kept.outliers.size());
        return make_reference(sheet.mesh, kept.points, kTolerance / 2, {}, nullptr);
      });
  ASSERT_GT(excluded.size(), 1u);
  EXPECT_EQ(excluded.front(), 8u);
  EXPECT_LT(excluded.back(), 8u);
  const ExactMesh reference(made.reference.surface.mesh.view());
  const auto beyond = std::ranges::count_if(
      points, [&](const Point& p) { return reference.distance(p).upper > kTolerance; });
  EXPECT_LE(beyond, 8);
}

TEST(ReferenceWithRoom, TakesTwiceTheRoomThatIsMissing) {
  EXPECT_EQ(fewer_excluded(8, 0, 8, 0), std::nullopt);
  EXPECT_EQ(fewer_excluded(8, 3, 8, 0), 2u);
  EXPECT_EQ(fewer_excluded(2, 6, 8, 1), std::nullopt);
  EXPECT_EQ(fewer_excluded(8, 5, 8, 0), std::nullopt);  // more than there are
  EXPECT_EQ(fewer_excluded(8, 3, 8, 4), std::nullopt);
}

TEST(TiledScan, SaysWhereTooManyPointsAreFar) {
  const SpikedSheet sheet(400);
  const ScanPieces pieces(sheet.scan);
  TiledScanSettings wanted = settings();
  wanted.memory = 1000;
  EXPECT_NE(test::message_of([&] { TiledScan(pieces, sheet.mesh, wanted); }).find("--memory"),
            std::string::npos);
}

}  // namespace
}  // namespace emax
