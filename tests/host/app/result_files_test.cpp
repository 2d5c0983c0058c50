#include "host/app/result_files.h"

#include <gtest/gtest.h>

#include "host/files/sha256.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

// A bumpy sphere that is its own reference.
class ResultFilesTest : public testing::Test {
 protected:
  ResultFilesTest() {
    options_.output = (folder_ / "mesh.ply").string();
    settings_.output = options_.output;
    settings_.epsilon_back = kEpsilon;
    settings_.bound.reference = {sphere_.vertices, sphere_.triangles};
  }

  ResultFiles files() { return {options_, settings_, scan_, cloud_sha256_, constraint_}; }
  BestMesh best(std::size_t triangles) {
    BestMesh best = {};
    best.index = index_++;
    best.mesh = settings_.bound.reference;
    best.mesh.triangles.resize(triangles);
    best.triangles = triangles;
    best.error = constraint_.measure(best.mesh.view());
    return best;
  }
  std::size_t all() const { return sphere_.triangles.size(); }
  bool exists(const std::string& name) { return std::filesystem::exists(folder_ / name); }

  std::uint64_t index_ = 0;
  static constexpr double kEpsilon = 0.5;
  const Stimulus sphere_ = bumpy_sphere(8, 12, 300, 1);
  TemporaryFolder folder_;
  OptimizeOptions options_;
  OptimizeSettings settings_;
  const Scan scan_ = {"scan.xyz", {sphere_.cloud, {}, {}}, 2};
  const std::string cloud_sha256_ = sha256("a scan");
  ErrorConstraint constraint_{sphere_.cloud, kEpsilon, 0};
};

TEST_F(ResultFilesTest, TheReferenceIsAResultAsItIs) {
  const ProvenMesh proven = files().write(best(all()), 0);
  ASSERT_TRUE(proven.reference);
  EXPECT_LE(proven.reference->mesh_to_reference, kEpsilon);
  const Certificate there = read_certificate(folder_ / "mesh.ply.certificate.json");
  EXPECT_EQ(there.triangles, all());
  EXPECT_EQ(there.reference->sha256, sha256_of_file(folder_ / "mesh.ply.reference.ply"));
  EXPECT_EQ(there.mesh_sha256, sha256_of_file(folder_ / "mesh.ply"));
}

TEST_F(ResultFilesTest, ABetterMeshIsSeenOnlyUnderTheSameBounds) {
  EXPECT_FALSE(files().hold_fewer_than(all() + 1));  // nothing is there
  files().write(best(all()), 0);
  EXPECT_TRUE(files().hold_fewer_than(all() + 1));
  EXPECT_FALSE(files().hold_fewer_than(all()));

  const auto changed = [&](auto change, auto back) {
    change();
    const bool holds = files().hold_fewer_than(all() + 1);
    back();
    EXPECT_TRUE(files().hold_fewer_than(all() + 1));
    return holds;
  };
  EXPECT_FALSE(
      changed([&] { settings_.epsilon_back.reset(); }, [&] { settings_.epsilon_back = kEpsilon; }));
  EXPECT_FALSE(changed([&] { settings_.epsilon_back = 2 * kEpsilon; },
                       [&] { settings_.epsilon_back = kEpsilon; }));
  const Point first = settings_.bound.reference.vertices.front();
  EXPECT_FALSE(changed([&] { settings_.bound.reference.vertices.front() *= 1.01; },
                       [&] { settings_.bound.reference.vertices.front() = first; }));
  EXPECT_FALSE(changed([&] { options_.common.reading.skip_invalid = true; },
                       [&] { options_.common.reading.skip_invalid = false; }));
  // Not the mesh that was certified, and no certificate at all.
  folder_.write("mesh.ply", "another");
  EXPECT_FALSE(files().hold_fewer_than(all() + 1));
  folder_.write("mesh.ply.certificate.json", "{}");
  EXPECT_FALSE(files().hold_fewer_than(all() + 1));
}

TEST_F(ResultFilesTest, TheReferenceIsWrittenOnce) {
  ResultFiles written = files();
  written.write(best(all()), 0);
  std::filesystem::remove(folder_ / "mesh.ply.reference.ply");
  written.write(best(all()), 1);
  EXPECT_FALSE(exists("mesh.ply.reference.ply"));
}

TEST_F(ResultFilesTest, TheReferenceMayStandAlone) {
  files().write_reference();
  EXPECT_TRUE(exists("mesh.ply.reference.ply"));
  EXPECT_FALSE(exists("mesh.ply"));
  EXPECT_FALSE(exists("mesh.ply.certificate.json"));
}

// A mesh that strays from the reference, or one that misses points, is a defect and is not written.
TEST_F(ResultFilesTest, NothingUntrueIsWritten) {
  BestMesh strayed = best(all());
  for (Point& p : strayed.mesh.vertices) p *= 1.9;
  EXPECT_THROW(files().write(strayed, 1), Error);
  settings_.epsilon_back.reset();
  EXPECT_THROW(files().write(strayed, 1), Error);
  settings_.epsilon_back = kEpsilon;
  settings_.bound.reference = strayed.mesh;
  EXPECT_THROW(files().write(best(all()), 1), Error);
  for (const char* name : {"mesh.ply", "mesh.ply.certificate.json"}) EXPECT_FALSE(exists(name));
}

}  // namespace
}  // namespace emax::test
