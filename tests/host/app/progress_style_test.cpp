// --quiet and --progress of the commands.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/host/app/program.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;
using Arguments = std::vector<std::string>;

class ProgressStyles : public testing::Test {
 protected:
  ProgressStyles() {
    test::write_scan(folder_ / "scan.xyz", 400, 2);
    test::write_surface(folder_ / "surface.off", 12, 16);
  }

  ProgramRun emax(Arguments arguments, const Arguments& more = {}) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_emax(arguments, folder_.path());
  }
  ProgramRun optimize(const Arguments& more) {
    return emax({"optimize", "scan.xyz", "--max-error", "20%", "-o", "mesh.ply", "--budget", "2",
                 "--bound", "one-sided", "--method", "gp3"},
                more);
  }

  test::TemporaryFolder folder_;
};

TEST_F(ProgressStyles, QuietPrintsNothingButErrors) {
  const std::vector<std::pair<Arguments, int>> commands = {
      {{"decimate", "surface.off", "--max-error", "5%", "-o", "small.ply"}, 0},
      {{"error", "scan.xyz", "surface.off", "--max-error", "1e-9"}, 2},
      {{"verify", "small.ply.certificate.json"}, 0},
  };
  for (const auto& [command, exit_code] : commands) {
    SCOPED_TRACE(command.front());
    EXPECT_NE(emax(command).output, "");
    for (const char* quiet : {"--quiet", "-q"}) {
      const ProgramRun run = emax(command, {quiet});
      EXPECT_EQ(run.exit_code, exit_code);
      EXPECT_EQ(run.output, "");
      EXPECT_EQ(run.errors, "");
    }
  }
  EXPECT_EQ(optimize({"-q"}).errors, "");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "mesh.ply"));
  EXPECT_NE(emax({"error", "missing.xyz", "surface.off", "-q"}).errors, "");
}

TEST_F(ProgressStyles, QuietLeavesTheJson) {
  const Arguments command = {"error", "scan.xyz", "surface.off", "--json", "-"};
  const ProgramRun run = emax(command, {"--quiet"});
  EXPECT_EQ(run.errors, "");
  EXPECT_EQ(run.output, emax(command).output);
}

TEST_F(ProgressStyles, JsonIsALineForEachChange) {
  const ProgramRun run = optimize({"--progress", "json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output, "");
  std::istringstream lines(run.errors);
  std::vector<json> told;
  for (std::string line; std::getline(lines, line);) told.push_back(json::parse(line));
  ASSERT_GE(told.size(), 3u) << run.errors;
  EXPECT_EQ(told.front().at("phase"), "reading the cloud");
  std::uint64_t evaluations = 0;
  std::vector<json> of_the_search;
  for (const json& change : told) {
    EXPECT_GE(change.at("seconds"), 0);
    EXPECT_TRUE(change.at("seconds_left").is_null() || change.at("seconds_left") >= 0);
    if (!change.contains("evaluations")) continue;
    of_the_search.push_back(change);
    EXPECT_GE(change.at("evaluations"), evaluations);
    evaluations = change.at("evaluations");
    EXPECT_EQ(change.at("budget"), 2);
  }
  ASSERT_GE(of_the_search.size(), 2u);
  EXPECT_EQ(evaluations, 2u);
  EXPECT_GT(of_the_search.back().at("triangles"), 0);
  EXPECT_LE(of_the_search.back().at("e_max"), 1);
}

TEST_F(ProgressStyles, NoneIsQuietOnStandardErrorAlone) {
  const ProgramRun run = optimize({"--progress", "none"});
  EXPECT_EQ(run.errors, "");
  EXPECT_NE(run.output, "");
  const ProgramRun both = optimize({"--quiet", "--progress", "json"});
  EXPECT_NE(both.errors, "");
  EXPECT_EQ(both.output, "");
  EXPECT_EQ(optimize({"--progress", "loud"}).exit_code, 1);
}

}  // namespace
}  // namespace emax
