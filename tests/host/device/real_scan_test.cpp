#include <gtest/gtest.h>

#include "evaluator_of.h"
#include "host/block_search/block_search.h"
#include "host/device/device_address.h"
#include "host/files/mesh_file.h"
#include "host/geometry/bounds.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

// The scan that `./dev data` fetches, as cloud, and its triangles with every vertex displaced by up
// to 0.3 % of the width, as mesh.
class RealScan : public testing::Test {
 protected:
  RealScan() : mesh_(read_mesh(EMAX_DATA_FOLDER "/bunny00.off")), scan_(mesh_.vertices) {
    test::Random random(77);
    const double most = 0.003 * bounds_of(scan_).width();
    for (Point& vertex : mesh_.vertices) vertex += most * random.point(-1, 1);
  }

  std::vector<Point> every(std::size_t step) const {
    std::vector<Point> points;
    for (std::size_t i = 0; i < scan_.size(); i += step) points.push_back(scan_[i]);
    return points;
  }

  TriangleMesh mesh_;
  std::vector<Point> scan_;
};

TEST_F(RealScan, AllEnginesAgreeOnASample) {
  const PreparedCloud cloud(every(150));
  const TriangleTree tree(mesh_.view(), cloud.normalization());
  const EmaxResult expected = emax_model(cloud.points(), tree.records());
  for (const char* device : {"cpu", "sim", "sim:filter"}) {
    const auto evaluator = test::evaluator_of(device);
    EXPECT_EQ(search_emax(cloud, tree, *evaluator), expected) << device;
    EXPECT_EQ(brute_force_emax(cloud, tree, *evaluator), expected) << device;
  }
}

TEST_F(RealScan, SearchEqualsBruteForceOnEveryFourthPoint) {
  const PreparedCloud cloud(every(4));
  const TriangleTree tree(mesh_.view(), cloud.normalization());
  const auto cpu = test::evaluator_of("cpu");
  const std::vector<std::uint32_t> all_pairs = brute_force_nearest(cloud, tree, *cpu);
  EXPECT_EQ(search_nearest(cloud, tree, *cpu), all_pairs);
  EXPECT_EQ(search_emax(cloud, tree, *cpu), worst_of(all_pairs));
}

TEST_F(RealScan, DeviceEqualsCpuOnTheWhole) {
  const PreparedCloud cloud(scan_);
  const TriangleTree tree(mesh_.view(), cloud.normalization());
  const auto cpu = test::evaluator_of("cpu");
  const auto sim = test::evaluator_of("sim");
  const EmaxResult expected = search_emax(cloud, tree, *cpu);
  EXPECT_EQ(search_emax(cloud, tree, *sim), expected);
  EXPECT_EQ(search_emax(cloud, tree, *test::evaluator_of("sim:filter")), expected);
}

}  // namespace
}  // namespace emax
