// `emax reconstruct` as a person sees it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/files/mesh_file.h"
#include "tests/host/app/program.h"
#include "tests/host/support/corner_positions.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;

class ReconstructCommand : public testing::Test {
 protected:
  ReconstructCommand() { test::write_scan(folder_ / "scan.xyz", 8000, 2); }

  ProgramRun reconstruct(const std::string& output, std::vector<std::string> more = {},
                         double stop_after_seconds = 0) {
    more.insert(more.begin(), {"reconstruct", "scan.xyz", "-o", output});
    return test::run_emax(more, folder_.path(), stop_after_seconds);
  }
  std::string bytes(const std::string& name) { return test::file_text(folder_ / name); }

  std::vector<test::CornerPositions> triangles(const std::string& name) {
    return test::corner_positions(read_mesh(folder_ / name));
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReconstructCommand, GivesTheSameSurfaceAsAWholeAndInTiles) {
  const std::vector<std::string> values = {"--set", "normals.k=20", "--set", "imls.least_reach=0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), values.begin(), values.end());
    return more;
  };
  ASSERT_EQ(reconstruct("whole.ply", with({"--method", "imls", "--json", "w.json"})).exit_code, 0);
  const ProgramRun tiled =
      reconstruct("tiled.ply", with({"--tile-points", "1500", "--json", "t.json"}));
  ASSERT_EQ(tiled.exit_code, 0) << tiled.errors;
  EXPECT_NE(tiled.output.find("valid: manifold"), std::string::npos) << tiled.output;
  EXPECT_EQ(triangles("tiled.ply"), triangles("whole.ply"));
  const json whole = json::parse(bytes("w.json")), parts = json::parse(bytes("t.json"));
  EXPECT_EQ(whole["tiles"], 0);
  EXPECT_GE(parts["tiles"], 6);
  EXPECT_EQ(whole["topology"], parts["topology"]);
  EXPECT_EQ(parts["triangles"], triangles("tiled.ply").size());
  EXPECT_FALSE(exists(folder_ / "tiled.ply.tiles"));
  // Less memory, and other processes.
  for (const std::string jobs : {"1", "2"}) {
    ASSERT_EQ(
        reconstruct("small" + jobs + ".ply", with({"--memory", "12MB", "--jobs", jobs})).exit_code,
        0);
  }
  EXPECT_EQ(triangles("small1.ply"), triangles("whole.ply"));
  EXPECT_EQ(bytes("small1.ply"), bytes("small2.ply"));
}

TEST_F(ReconstructCommand, MakesTheSameBytesOnAnyNumberOfThreads) {
  for (const std::string method : {"gp3", "imls"}) {
    ASSERT_EQ(reconstruct("one.ply", {"--method", method, "--jobs", "1"}).exit_code, 0);
    ASSERT_EQ(reconstruct("two.ply", {"--method", method, "--jobs", "2"}).exit_code, 0);
    EXPECT_EQ(bytes("one.ply"), bytes("two.ply")) << method;
  }
}

// The thinned cloud as a whole has a box of its own, so the surfaces differ by roundings.
TEST_F(ReconstructCommand, ThinsAlikeAsAWholeAndInTiles) {
  const auto made = [&](const std::string& output, std::vector<std::string> more) {
    more.insert(more.end(), {"--thin", "3%", "--set", "imls.least_reach=0", "--set", "normals.k=20",
                             "--json", "r.json"});
    const ProgramRun run = reconstruct(output, more);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.output.find("one in a cube of"), std::string::npos) << run.output;
    return json::parse(bytes("r.json"));
  };
  const json whole = made("whole.ply", {"--method", "imls"});
  const json tiled = made("tiled.ply", {"--tile-points", "1500"});
  EXPECT_LT(whole["taken"], 5000);
  for (const char* same : {"taken", "triangles", "topology"}) EXPECT_EQ(tiled[same], whole[same]);
  EXPECT_NE(reconstruct("out.ply", {"--thin", "much"}).errors.find("--thin"), std::string::npos);
  EXPECT_NE(reconstruct("out.ply", {"--thin", "3mm"}).errors.find("--thin"), std::string::npos);
}

TEST_F(ReconstructCommand, SimplifiesAsAWholeAndInTiles) {
  const auto made = [&](const std::string& output, std::vector<std::string> more) {
    more.insert(more.end(), {"--method", "imls", "--json", "r.json"});
    const ProgramRun run = reconstruct(output, more);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return json::parse(bytes("r.json"));
  };
  const json fine = made("fine.ply", {});
  const json whole = made("whole.ply", {"--simplify", "0.2%"});
  const json tiled = made("tiled.ply", {"--simplify", "0.2%", "--tile-points", "1500"});
  const json again =
      made("again.ply", {"--simplify", "0.2%", "--tile-points", "1500", "--jobs", "2"});
  EXPECT_LT(whole["triangles"].get<int>(), fine["triangles"].get<int>() / 4);
  EXPECT_LT(tiled["triangles"].get<int>(), fine["triangles"].get<int>() / 2);
  for (const json* simplified : {&whole, &tiled}) {
    EXPECT_EQ((*simplified)["topology"], fine["topology"]);
    EXPECT_EQ((*simplified)["validity"]["self_intersections"], 0);
  }
  EXPECT_EQ(bytes("again.ply"), bytes("tiled.ply"));
  EXPECT_NE(reconstruct("out.ply", {"--simplify", "9e9"}).errors.find("--simplify"),
            std::string::npos);
}

TEST_F(ReconstructCommand, GoesOnAfterAnInterruption) {
  const std::vector<std::string> tiles = {"--tile-points", "1000"};
  ASSERT_EQ(reconstruct("undisturbed.ply", tiles).exit_code, 0);
  const ProgramRun stopped = reconstruct("out.ply", tiles, 0.4);
  ASSERT_EQ(stopped.exit_code, 130) << stopped.errors;
  EXPECT_FALSE(exists(folder_ / "out.ply"));
  ASSERT_TRUE(exists(folder_ / "out.ply.tiles"));
  const ProgramRun other = reconstruct("out.ply", {"--tile-points", "1001"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.errors.find("of another command"), std::string::npos) << other.errors;
  const ProgramRun again = reconstruct("out.ply", tiles);
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_NE(again.output.find("continued"), std::string::npos) << again.output;
  EXPECT_EQ(bytes("out.ply"), bytes("undisturbed.ply"));
  EXPECT_FALSE(exists(folder_ / "out.ply.tiles"));
}

// Surface and decimation by one command.
TEST_F(ReconstructCommand, OptimizesInTiles) {
  const auto optimize = [&](std::vector<std::string> more, double stop_after_seconds = 0) {
    more.insert(more.begin(),
                {"optimize", "scan.xyz", "--max-error", "2%", "-o", "part.ply", "--tiles", "6000"});
    return test::run_emax(more, folder_.path(), stop_after_seconds);
  };
  const ProgramRun made = optimize({"--json", "r.json"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_NE(made.output.find("from reference"), std::string::npos) << made.output;
  EXPECT_LT(json::parse(bytes("r.json"))["triangles"], 1000);
  EXPECT_EQ(test::run_emax({"verify", "part.ply.certificate.json"}, folder_.path()).exit_code, 0);
  EXPECT_FALSE(exists(folder_ / "part.ply.tiles"));
  EXPECT_NE(exists(folder_ / "part.ply.surface.ply"), exists(folder_ / "part.ply.reference.ply"));
  const std::string expected = bytes("part.ply");
  std::filesystem::remove(folder_ / "part.ply");
  const ProgramRun stopped = optimize({}, 0.2);
  EXPECT_EQ(stopped.exit_code, 130) << stopped.errors;
  EXPECT_TRUE(exists(folder_ / "part.ply.tiles"));
  ASSERT_EQ(optimize({"--jobs", "1"}).exit_code, 0);
  EXPECT_EQ(bytes("part.ply"), expected);
  EXPECT_NE(optimize({"--method", "gp3"}).errors.find("--tiles cannot be combined with --method"),
            std::string::npos);
  EXPECT_NE(optimize({"--budget", "20"}).errors.find("--budget"), std::string::npos);
}

TEST_F(ReconstructCommand, RefusesWhatItCannotDo) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& why) {
    const ProgramRun run = reconstruct("out.ply", more);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find(why), std::string::npos) << run.errors;
    EXPECT_FALSE(exists(folder_ / "out.ply"));
    EXPECT_FALSE(exists(folder_ / "out.ply.tiles"));
  };
  refused({"--method", "gp3", "--tile-points", "1000"}, "takes a cloud as a whole alone");
  refused({"--method", "imls", "--set", "imls.cell"}, "a number from 0.5 to 3");
  refused({"--method", "imls", "--set", "imls.cell=9"}, "a number from 0.5 to 3");
  refused({"--method", "imls", "--set", "normals.k=20.5"}, "a whole number");
  refused({"--method", "imls", "--set", "gp3.mu=2"}, "choose one of normals.k");
  refused({"--tile-points", "1000", "--set", "imls.cell=9"}, "a number from 0.5 to 3");
  refused({"--tile-points", "10"}, "--tile-points");
  refused({"--tile-points", "2000", "--tile-folder", "none/tiles"}, "none");
}

}  // namespace
}  // namespace emax
