#include "host/app/reference_file.h"

#include <gtest/gtest.h>

#include "host/app/certified_result.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

// A bumpy sphere whose first point lies off it.
class ReferenceFileTest : public testing::Test {
 protected:
  ReferenceFileTest() { scan_.cloud.points.front() *= 3; }

  double distance_without(const std::vector<std::uint32_t>& excluded) const {
    return certify(scan_.cloud.points, mesh_.view(), excluded).e_max_upper;
  }

  TemporaryFolder folder_;
  const Stimulus sphere_ = bumpy_sphere(8, 12, 300, 1);
  const TriangleMesh mesh_ = {sphere_.vertices, sphere_.triangles};
  Scan scan_ = {"scan.xyz", {sphere_.cloud, {}, {}}, 2};
  ReferenceFile file_{folder_ / "mesh.ply.reference.ply", mesh_, scan_.cloud.points};
};

TEST_F(ReferenceFileTest, SaysWhatItsFileHolds) {
  ReferenceBound bound;
  bound.mesh_to_reference = 0.25;
  file_.describe(bound, {});
  EXPECT_EQ(bound.file, "mesh.ply.reference.ply");
  EXPECT_EQ(bound.sha256, sha256(mesh_bytes(mesh_, MeshFormat::kPly)));
  EXPECT_EQ(bound.triangles, mesh_.triangles.size());
  EXPECT_EQ(bound.topology, topology_of(mesh_.view()));
  EXPECT_EQ(bound.mesh_to_reference, 0.25);
}

// Also where the points that are left out change from one result to the next.
TEST_F(ReferenceFileTest, MeasuresThePointsThatAreKept) {
  ASSERT_LT(distance_without({0}), distance_without({}));
  for (const std::vector<std::uint32_t>& excluded :
       {std::vector<std::uint32_t>{}, std::vector<std::uint32_t>{0},
        std::vector<std::uint32_t>{}}) {
    ReferenceBound bound;
    file_.describe(bound, excluded);
    EXPECT_EQ(bound.points_to_reference, distance_without(excluded)) << excluded.size();
  }
}

TEST_F(ReferenceFileTest, IsWrittenWithTheFirstResultAlone) {
  const ProvenMesh proven;
  const std::string sha256 = "of a scan";
  const CertifiedResult result = {
      .cloud = {scan_, sha256}, .epsilon = 1, .mesh = mesh_, .proven = proven};
  write_result(folder_ / "mesh.ply", result, &file_);
  EXPECT_EQ(sha256_of_file(file_.path()), file_.sha256());
  std::filesystem::remove(file_.path());
  write_result(folder_ / "other.ply", result, &file_);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "other.ply"));
  EXPECT_FALSE(std::filesystem::exists(file_.path()));
}

TEST_F(ReferenceFileTest, AFileThatIsThereIsLeftAlone) {
  ReferenceFile there(folder_ / "given.off", mesh_, scan_.cloud.points, "its checksum");
  EXPECT_EQ(there.unwritten(), nullptr);
  ReferenceBound bound;
  there.describe(bound, {});
  EXPECT_EQ(bound.sha256, "its checksum");
}

}  // namespace
}  // namespace emax::test
