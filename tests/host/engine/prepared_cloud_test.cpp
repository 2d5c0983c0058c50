#include "host/engine/prepared_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(PreparedCloud, GroupsHoldEveryPointOnceInsideItsBox) {
  for (const test::Stimulus& s : test::all_stimuli(41)) {
    SCOPED_TRACE(s.name + ", seed 41");
    const PreparedCloud cloud(s.cloud);
    std::vector<int> seen(s.cloud.size(), 0);
    for (const PointGroup& group : cloud.groups()) {
      EXPECT_LE(group.points.size(), PreparedCloud::kGroupPoints);
      EXPECT_TRUE(std::ranges::is_sorted(group.points));
      for (const std::uint32_t i : group.points) {
        ++seen[i];
        const Vector3<float>& p = cloud.points()[i];
        EXPECT_TRUE(group.box.contains(Point(p.x, p.y, p.z)));
      }
    }
    EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; }));
  }
}

}  // namespace
}  // namespace emax
