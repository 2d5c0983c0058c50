// `emax features` as a person sees it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/files/cloud_file.h"
#include "host/files/input_file.h"
#include "tests/host/app/program.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;

// The inside of a room of 4 by 3 by 2.5 without its ceiling, in some noise.
class FeaturesCommand : public testing::Test {
 protected:
  FeaturesCommand() {
    Random random(named_seed("room", 1));
    std::ofstream file(folder_ / "room.xyz");
    file.precision(17);
    const Point size(4, 3, 2.5);
    for (int i = 0; i < 5 * kOfSide; ++i) {
      Point p = random.point(0, 1).cwiseProduct(size);
      const int side = i / kOfSide, axis = side == 0 ? 2 : (side - 1) / 2;
      p[axis] = (side > 0 && side % 2 == 0 ? size[axis] : 0) + random.uniform(-0.004, 0.004);
      file << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    }
  }

  ProgramRun features(std::vector<std::string> more) {
    more.insert(more.begin(), {"features", "room.xyz"});
    return test::run_emax(more, folder_.path());
  }
  std::string bytes(const std::string& name) { return test::file_text(folder_ / name); }

  static constexpr int kOfSide = 2000;
  test::TemporaryFolder folder_;
};

TEST_F(FeaturesCommand, ListsTheSidesOfARoom) {
  for (const std::string method : {"growing", "hough"}) {
    const ProgramRun run =
        features({"--max-error", "0.02", "--method", method, "--json", "f.json"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.output.find("5 planes, 0 cylinders, 0 spheres"), std::string::npos) << run.output;
    const json told = json::parse(bytes("f.json"));
    EXPECT_EQ(told["schema"], "emax-features-1");
    EXPECT_EQ(told["max_error"], 0.02);
    ASSERT_EQ(told["regions"].size(), 5);
    double area = 0;
    for (const json& region : told["regions"]) {
      EXPECT_EQ(region["kind"], "plane");
      EXPECT_GT(region["points"], 0.9 * kOfSide);
      EXPECT_LT(region["rms"], 0.004);
      area += region["area"].get<double>();
    }
    EXPECT_NEAR(area, 12 + 2 * 10 + 2 * 7.5, 5);
  }
}

TEST_F(FeaturesCommand, GivesTheSameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(features({"--jobs", "1", "-o", "one.ply", "--json", "one.json"}).exit_code, 0);
  ASSERT_EQ(features({"--jobs", "3", "-o", "three.ply", "--json", "three.json"}).exit_code, 0);
  EXPECT_EQ(bytes("one.ply"), bytes("three.ply"));
  EXPECT_EQ(bytes("one.json"), bytes("three.json"));
}

// Our own readers take the files for what they are, with all points.
TEST_F(FeaturesCommand, WritesPointsByRegion) {
  const ProgramRun run = features({"--max-error", "0.02", "--unit", "m", "-o", "r.ply", "-o",
                                   "r.obj", "-o", "r.glb", "-o", "r.dxf"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(read_cloud(folder_ / "r.ply").points, read_cloud(folder_ / "room.xyz").points);
  EXPECT_EQ(read_cloud(folder_ / "r.obj").points, read_cloud(folder_ / "room.xyz").points);
  EXPECT_EQ(read_cloud(folder_ / "r.glb").points.size(), 5u * kOfSide);
  EXPECT_NE(bytes("r.obj").find("\ng plane_5\np "), std::string::npos);
  EXPECT_NE(bytes("r.glb").find("\"plane_5\""), std::string::npos);
  const std::string dxf = bytes("r.dxf");
  std::size_t polylines = 0;
  for (std::size_t at = 0; (at = dxf.find("\nPOLYLINE\n", at)) != std::string::npos; ++at) {
    ++polylines;
  }
  EXPECT_EQ(polylines, 5u);
  EXPECT_NE(dxf.find("$INSUNITS\n70\n6\n"), std::string::npos);  // metres
}

TEST_F(FeaturesCommand, FindsNothingWhereNothingIs) {
  test::write_scan(folder_ / "round.xyz", 500, 3);
  const ProgramRun run = test::run_emax(
      {"features", "round.xyz", "--max-error", "0.001", "-o", "r.dxf"}, folder_.path());
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("0 planes, 0 cylinders, 0 spheres"), std::string::npos) << run.output;
  EXPECT_TRUE(exists(folder_ / "r.dxf"));
}

TEST_F(FeaturesCommand, EndsWhenItIsInterrupted) {
  test::write_scan(folder_ / "large.xyz", 400'000, 3);
  const ProgramRun run = test::run_emax(
      {"features", "large.xyz", "--max-error", "0.001", "-o", "r.ply", "--jobs", "1"},
      folder_.path(), 0.7);
  EXPECT_EQ(run.exit_code, 130) << run.output;
  EXPECT_NE(run.errors.find("interrupted; nothing was written"), std::string::npos) << run.errors;
  EXPECT_FALSE(exists(folder_ / "r.ply"));
}

TEST_F(FeaturesCommand, RefusesWhatCannotBe) {
  const std::vector<std::vector<std::string>> refused = {{"-o", "room.xyz"},
                                                         {"-o", "r.stl"},
                                                         {"--max-error", "9"},
                                                         {"--max-error", "-1"},
                                                         {"--least-points", "3"},
                                                         {"--method", "guess"},
                                                         {"-o", "r.ply", "-o", "r.ply"}};
  for (const auto& words : refused) {
    const ProgramRun run = features(words);
    EXPECT_NE(run.exit_code, 0) << words.back();
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    EXPECT_FALSE(exists(folder_ / "r.ply")) << words.back();
  }
}

}  // namespace
}  // namespace emax
