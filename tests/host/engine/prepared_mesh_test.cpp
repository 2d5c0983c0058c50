#include "host/engine/prepared_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "sw_model/model/triangle_frame.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(PreparedMesh, HasTheModelsRecordsAlongACurve) {
  for (const test::Stimulus& s : test::all_stimuli(70)) {
    SCOPED_TRACE(s.name + ", seed 70");
    const Normalization normalization = normalization_of(s.cloud);
    const auto expected = make_records(s.mesh(), normalization);
    for (const EngineTarget& target : engine_targets()) {
      const PreparedMesh mesh(s.mesh(), normalization, target);
      std::vector<int> seen(expected.size(), 0);
      for (const TriangleRecord<float>& record : mesh.records()) {
        const std::uint32_t triangle = record.tag & ~kSegmentFlag;
        ++seen.at(triangle);
        EXPECT_EQ(std::memcmp(&record, &expected[triangle], sizeof record), 0)
            << target.name << ", triangle " << triangle;
      }
      EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; }));
    }
  }
}

TEST(PreparedMesh, IsTheSameFromAnyNumberOfThreads) {
  const test::Stimulus s = test::bumpy_sphere(90, 121, 1000, 80);
  const Normalization normalization = normalization_of(s.cloud);
  const EngineTarget& target = engine_targets().front();
  const PreparedMesh one(s.mesh(), normalization, target, 1);
  const TreeView expected = one.tree();
  for (const std::size_t threads : {2u, 3u, 8u}) {
    const PreparedMesh mesh(s.mesh(), normalization, target, threads);
    const TreeView tree = mesh.tree();
    EXPECT_EQ(tree.reach, expected.reach);
    EXPECT_EQ(std::memcmp(tree.records.data(), expected.records.data(), tree.records.size_bytes()),
              0);
    ASSERT_EQ(tree.levels.size(), expected.levels.size());
    for (std::size_t level = 0; level < tree.levels.size(); ++level) {
      EXPECT_EQ(std::memcmp(tree.levels[level].data(), expected.levels[level].data(),
                            expected.levels[level].size_bytes()),
                0);
    }
  }
}

// Against every pair.
TEST(MeshLeaves, FindsTheTrianglesThatStayed) {
  test::Random random(81);
  const test::Stimulus before = test::bumpy_sphere(15, 20, 100, 81);
  test::Stimulus now = before;
  for (int i = 0; i < 30; ++i) {
    now.vertices[random.below(now.vertices.size())] += Point(0, 0, 1e-5);
  }
  std::ranges::reverse(now.triangles);
  for (std::size_t i = 0; i < now.triangles.size(); i += 7) {
    std::swap(now.triangles[i][0], now.triangles[i][1]);  // turned over: another triangle
  }
  const Normalization normalization = normalization_of(before.cloud);
  const PreparedMesh old_mesh(before.mesh(), normalization), new_mesh(now.mesh(), normalization);
  const std::vector<std::uint32_t> carried = old_mesh.leaves()->carried_to(*new_mesh.leaves());
  ASSERT_EQ(carried.size(), before.triangles.size() + 1);
  EXPECT_EQ(carried.back(), kNoLeaf);
  const auto corners_of = [](const TriangleRecord<float>& record, const test::Stimulus& s) {
    return s.mesh().corners(record.tag & ~kSegmentFlag);
  };
  std::size_t stayed = 0;
  for (std::uint32_t i = 0; i < before.triangles.size(); ++i) {
    const auto corners = corners_of(old_mesh.records()[i], before);
    std::vector<std::uint32_t> same;
    for (std::uint32_t j = 0; j < now.triangles.size(); ++j) {
      if (corners_of(new_mesh.records()[j], now) == corners) same.push_back(j);
    }
    if (same.empty()) {
      EXPECT_EQ(carried[i], kNoLeaf) << i;
    } else {
      EXPECT_NE(std::ranges::find(same, carried[i]), same.end()) << i;
      ++stayed;
    }
  }
  EXPECT_GT(stayed, before.triangles.size() / 4);
  EXPECT_LT(stayed, before.triangles.size());
}

}  // namespace
}  // namespace emax
