#include "host/engine/mesh_batch.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "host/block_search/block_search.h"
#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(MeshBatch, HasEachMeshsOwnAnswerFromAnyNumberOfThreads) {
  std::vector<test::Stimulus> stimuli;
  for (const std::uint32_t rings : {10u, 11u, 10u, 5u, 14u, 3u, 10u}) {
    stimuli.push_back(test::bumpy_sphere(rings, 2 * rings, 10, 82));
  }
  const PreparedCloud cloud(test::bumpy_sphere(20, 30, 800, 82).cloud);
  std::vector<MeshView> meshes;
  std::vector<EmaxResult> expected;
  for (const test::Stimulus& s : stimuli) {
    meshes.push_back(s.mesh());
    expected.push_back(emax_model(cloud.points(), make_records(s.mesh(), cloud.normalization())));
  }
  EXPECT_NE(expected[0], expected[1]);
  for (const std::size_t threads : {1u, 2u, 3u, 16u}) {
    EngineOptions options;
    options.threads = threads;
    EXPECT_EQ(e_max_of_each(cloud, meshes, options), expected) << threads;
  }
}

TEST(MeshBatch, RefusesWhatAnEngineRefuses) {
  const test::Stimulus s = test::bumpy_sphere(5, 6, 100, 83);
  const PreparedCloud cloud(s.cloud);
  EXPECT_TRUE(e_max_of_each(cloud, {}).empty());
  const std::vector<MeshView> meshes = {s.mesh(), {}, s.mesh()};
  EXPECT_THROW(e_max_of_each(cloud, meshes), Error);
  EngineOptions none;
  none.threads = 0;
  EXPECT_THROW(e_max_of_each(cloud, {}, none), std::invalid_argument);
  EngineOptions interrupted;
  interrupted.interrupted = [] { return true; };
  EXPECT_THROW(e_max_of_each(cloud, std::vector{s.mesh()}, interrupted), Interrupted);
}

}  // namespace
}  // namespace emax
