#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "host/files/cloud_file.h"
#include "host/geometry/bounds.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/support/scan_generator/scan_writer.h"
#include "tests/support/scan_generator/scanner.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

std::vector<Point> scanned(const Scene& scene, const ScannerOptions& options) {
  std::vector<Point> points;
  const std::uint64_t count = Scanner(scene, options).scan([&](std::span<const Point> some) {
    points.insert(points.end(), some.begin(), some.end());
  });
  EXPECT_EQ(count, points.size());
  return points;
}

std::size_t farther(const Scene& scene, const std::vector<Point>& points, double limit) {
  const ExactMesh mesh(scene.mesh.view());
  return static_cast<std::size_t>(std::ranges::count_if(
      points, [&](const Point& p) { return mesh.distance(p).lower > limit; }));
}

Scene bumpy_statue() {
  const Stimulus s = bumpy_sphere(24, 32, 1, 5);
  return statue({s.vertices, s.triangles});
}

TEST(ScanGenerator, HasAboutAsManyPointsAsAreAskedFor) {
  for (const Scene& scene : {hall(), terrain(), bumpy_statue()}) {
    for (const double points : {5e3, 5e4}) {
      EXPECT_NEAR(static_cast<double>(scanned(scene, {.points = points}).size()), points,
                  0.05 * points);
    }
  }
}

TEST(ScanGenerator, PointsLieOnTheSurfaceWithoutNoise) {
  for (const Scene& scene : {hall(), terrain(), bumpy_statue()}) {
    const auto points = scanned(scene, {.points = 1e4, .noise = 0, .beam = 0});
    EXPECT_EQ(farther(scene, points, 1e-5), 0u);  // a ray at an edge meets the neighbour's plane
  }
}

TEST(ScanGenerator, NoiseAndMixedPixelsAreThoseAskedFor) {
  const Scene scene = hall();
  const auto noisy = scanned(scene, {.points = 2e4, .noise = 0.002, .beam = 0});
  EXPECT_EQ(farther(scene, noisy, 0.05), 0u);
  const auto beyond = static_cast<double>(farther(scene, noisy, 0.002));
  EXPECT_GT(beyond, 0.05 * static_cast<double>(noisy.size()));
  EXPECT_LT(beyond, 0.6 * static_cast<double>(noisy.size()));
  const auto mixed = scanned(scene, {.points = 2e4, .noise = 0, .beam = 0.01});
  const auto floating = static_cast<double>(farther(scene, mixed, 0.01));
  EXPECT_GT(floating, 0.0005 * static_cast<double>(mixed.size()));
  EXPECT_LT(floating, 0.05 * static_cast<double>(mixed.size()));
}

TEST(ScanGenerator, DensityFallsOffWithTheDistance) {
  Scene scene = hall();
  scene.stations.resize(1);
  const auto points = scanned(scene, {.points = 5e4});
  const Point& station = scene.stations[0];
  const auto on_floor = [&](double from, double to) {
    const double area = (to * to - from * from);
    return static_cast<double>(
               std::ranges::count_if(points,
                                     [&](const Point& p) {
                                       const double flat = (p - station).head<2>().norm();
                                       return std::abs(p[2]) < 0.05 && flat > from && flat < to;
                                     })) /
           area;
  };
  EXPECT_GT(on_floor(1, 2), 5 * on_floor(4, 5));
}

TEST(ScanGenerator, IsTheSameForAnyNumberOfThreadsAndDiffersWithTheSeed) {
  const Scene scene = terrain();
  const auto one = scanned(scene, {.points = 2e4});
  EXPECT_EQ(scanned(scene, {.points = 2e4, .threads = 3}), one);
  EXPECT_NE(scanned(scene, {.points = 2e4, .seed = 2}), one);
}

TEST(ScanGenerator, FilesHoldThePoints) {
  const Scene scene = bumpy_statue();
  const ScannerOptions options = {.points = 3000};
  const auto points = scanned(scene, options);
  const Scanner scanner(scene, options);
  const PointSource source = [&](const auto& take) { scanner.scan(take); };
  TemporaryFolder folder;
  std::ostringstream stream;
  write_ply_scan(folder / "a.ply", source);
  write_las_scan(folder / "a.las", source);
  write_e57_scan(folder / "a.e57", source);
  write_ply_scan(stream, points.size(), source);
  folder.write("b.ply", stream.str());
  for (const auto& [name, step] :
       {std::pair("a.ply", 1e-6), {"b.ply", 1e-6}, {"a.las", 6e-5}, {"a.e57", 6e-5}}) {
    const PointCloud cloud = read_cloud(folder / name);
    ASSERT_EQ(cloud.points.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_LT((cloud.points[i] - points[i]).cwiseAbs().maxCoeff(), step) << name;
    }
  }
}

// More points than a packet of E57 has.
TEST(ScanGenerator, E57HasTheNumbersOfLas) {
  const Scene scene = terrain();
  const Scanner scanner(scene, {.points = 20000});
  const PointSource source = [&](const auto& take) { scanner.scan(take); };
  TemporaryFolder folder;
  write_las_scan(folder / "a.las", source);
  write_e57_scan(folder / "a.e57", source);
  EXPECT_EQ(read_cloud(folder / "a.e57").points, read_cloud(folder / "a.las").points);
}

TEST(ScanGenerator, AStreamOfLasHasTheBytesOfTheFile) {
  const Scene scene = bumpy_statue();
  const Scanner scanner(scene, {.points = 3000});
  const PointSource source = [&](const auto& take) { scanner.scan(take); };
  TemporaryFolder folder;
  write_las_scan(folder / "a.las", source);
  std::ostringstream stream, file;
  write_las_scan(stream, source);
  file << std::ifstream(folder / "a.las", std::ios::binary).rdbuf();
  ASSERT_GT(stream.str().size(), 227u);
  EXPECT_EQ(stream.str(), file.str());

  const Bounds box = bounds_of(read_cloud(folder / "a.las").points);
  for (std::size_t k = 0; k < 3; ++k) {
    double bounds[2];  // greatest, least
    std::memcpy(bounds, stream.str().data() + 179 + 16 * k, sizeof bounds);
    EXPECT_EQ(bounds[0], box.upper[static_cast<Eigen::Index>(k)]);
    EXPECT_EQ(bounds[1], box.lower[static_cast<Eigen::Index>(k)]);
  }
}

}  // namespace
}  // namespace emax::test
