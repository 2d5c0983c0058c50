#include "host/tiles/cloud_partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "sw_model/base/error.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

std::vector<Point> cloud() {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> at(0, 10);
  std::vector<Point> points;
  for (int i = 0; i < 20000; ++i) {
    points.emplace_back(100 + at(generator), at(generator), 0.1 * at(generator));
  }
  return points;
}

CloudSource source_of(const std::vector<Point>& points) {
  return {normalization_of(points), [&points](const CloudSource::Take& take) {
            take(std::span(points).subspan(12345), 12345);
            take(std::span(points).first(12345), 0);
          }};
}

// Beside every point, one by one.
TEST(CloudPartition, GivesAPartWithWhatIsAroundIt) {
  const std::vector<Point> points = cloud();
  const TemporaryFolder folder;
  const CloudPartition written(source_of(points), 1500, folder.path());
  ASSERT_TRUE(CloudPartition::is_in(folder.path()));
  const CloudPartition read(folder.path());
  ASSERT_EQ(read.parts().size(), written.parts().size());
  EXPECT_EQ(read.points(), points.size());
  EXPECT_GT(read.parts().size(), 10u);
  for (const double halo : {0.0, 0.05, 0.5}) {
    for (std::size_t part = 0; part < read.parts().size(); ++part) {
      std::vector<std::uint64_t> expected;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3f at = read.normalization().apply(points[i]).cast<float>();
        const bool own = written.part_of(at) == part;
        if (own || squared_distance_from(read.parts()[part], at.cast<double>()) <= halo * halo) {
          expected.push_back(i);
        }
      }
      const std::vector<NumberedPoint> found = read.read(part, halo);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].number, expected[i]);
        EXPECT_EQ(found[i].position, points[expected[i]]);
      }
    }
  }
}

TEST(CloudPartition, MeasuresTheDistanceFromItsPlanes) {
  SpacePartition::Part part;
  part.first = {kSpaceCells / 2, 0, 0};                     // from x = 0
  part.last = {kSpaceCells, kSpaceCells / 2, kSpaceCells};  // to y = 0
  EXPECT_EQ(squared_distance_from(part, {0.5, -0.5, 7}), 0);
  EXPECT_EQ(squared_distance_from(part, {-0.25, -0.5, 0}), 0.0625);
  EXPECT_EQ(squared_distance_from(part, {-3, 4, 0}), 25);
  EXPECT_EQ(depth_within(part, {0.25, -0.5, 7}), 0.25);
  EXPECT_EQ(depth_within(part, {0.75, -0.5, 7}), 0.5);
  EXPECT_EQ(depth_within({}, {0, 0, 0}), std::numeric_limits<double>::infinity());
}

TEST(CloudPartition, RefusesAFolderThatHoldsNone) {
  const TemporaryFolder folder;
  EXPECT_FALSE(CloudPartition::is_in(folder.path()));
  EXPECT_NE(message_of([&] { CloudPartition{folder.path()}; }).find("parts of a cloud"),
            std::string::npos);
}

TEST(CloudPartition, TellsThatAPartWasCut) {
  const std::vector<Point> points = cloud();
  const TemporaryFolder folder;
  const CloudPartition partition(source_of(points), 1500, folder.path());
  std::filesystem::resize_file(folder / "points-3.bin", 1000);
  EXPECT_NE(message_of([&] { partition.read(3, 0); }).find("damaged"), std::string::npos);
}

}  // namespace
}  // namespace emax::test
