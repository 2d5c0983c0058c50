#include <gtest/gtest.h>

#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/files/mesh_file.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

TEST(DecimationEffort, IsQuickForMorePointsThanIsSaid) {
  const TemporaryFolder folder;
  write_mesh(folder / "sheet.ply", sheet(40, 0.2));  // 1,600 points
  const auto decimated = [&](const std::string& effort, std::size_t quick_beyond) {
    DecimateOptions options;
    options.mesh = (folder / "sheet.ply").string();
    options.max_error = "0.5%";
    options.output = (folder / "out.ply").string();
    options.effort = effort;
    options.quick_beyond = quick_beyond;
    EXPECT_EQ(run_decimate(options), kExitOk);
    return read_mesh(folder / "out.ply").triangles;
  };
  const std::vector<Triangle> quick = decimated("quick", 1600), normal = decimated("normal", 1600);
  EXPECT_LT(normal.size(), quick.size());
  EXPECT_EQ(decimated("normal", 1599), quick);
}

}  // namespace
}  // namespace emax::test
