// `emax info`, and what `emax optimize` says where the tolerance is missing.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/files/cloud_file.h"
#include "host/geometry/scan_estimate.h"
#include "tests/host/app/program.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;

class InfoCommand : public testing::Test {
 protected:
  InfoCommand() {
    test::write_scan(folder_ / "scan.xyz", 1500, 2);
    test::write_surface(folder_ / "surface.off", 10, 14);
  }

  ProgramRun emax(const std::vector<std::string>& arguments) {
    return test::run_emax(arguments, folder_.path());
  }

  test::TemporaryFolder folder_;
};

TEST_F(InfoCommand, SaysWhatACloudHolds) {
  const ProgramRun run = emax({"info", "scan.xyz"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("cloud          1,500 points\n"), std::string::npos) << run.output;
  const json told = json::parse(emax({"info", "scan.xyz", "--json", "-"}).output);
  const PointCloud cloud = read_cloud(folder_ / "scan.xyz");
  const ScanEstimate scan = estimate_scan(cloud.points);
  EXPECT_EQ(told.at("points"), 1500);
  EXPECT_EQ(told.at("triangles"), nullptr);
  EXPECT_EQ(told.at("spacing"), scan.spacing);
  EXPECT_EQ(told.at("noise"), scan.noise);
  EXPECT_EQ(told.at("suggested_max_error"), *suggested_tolerance(scan));
  for (int i = 0; i < 3; ++i) {
    double least = HUGE_VAL, greatest = -HUGE_VAL;
    for (const Point& p : cloud.points) {
      least = std::min(least, p[i]);
      greatest = std::max(greatest, p[i]);
    }
    EXPECT_EQ(told.at("lower").at(static_cast<std::size_t>(i)), least);
    EXPECT_EQ(told.at("upper").at(static_cast<std::size_t>(i)), greatest);
  }
}

TEST_F(InfoCommand, SaysWhatAMeshHolds) {
  const ProgramRun run = emax({"info", "surface.off"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("1 component, closed, genus 0"), std::string::npos) << run.output;
  const json told = json::parse(emax({"info", "surface.off", "--json", "-"}).output);
  EXPECT_GT(told.at("triangles"), 200);
  EXPECT_EQ(told.at("validity").at("self_intersections"), 0);
  EXPECT_EQ(told.at("topology").at("genus"), 0);
}

// So few points say nothing of a scan.
TEST_F(InfoCommand, SuggestsNothingForABox) {
  folder_.write("box.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n");
  const ProgramRun run = emax({"info", "box.xyz"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.output.find("--max-error"), std::string::npos) << run.output;
}

TEST_F(InfoCommand, RefusesWhatItCannotRead) {
  folder_.write("nothing.xyz", "");
  for (const char* file : {"nothing.xyz", "missing.xyz", "folder", "scan.unknown"}) {
    const ProgramRun run = emax({"info", file});
    EXPECT_EQ(run.exit_code, 1) << file;
    EXPECT_EQ(run.output, "") << file;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    EXPECT_NE(run.errors.find(file), std::string::npos) << run.errors;
  }
  const ProgramRun over = emax({"info", "scan.xyz", "--json", "scan.xyz"});
  EXPECT_EQ(over.exit_code, 1);
}

TEST_F(InfoCommand, OptimizeWithoutAToleranceSuggestsTheSame) {
  const ScanEstimate scan = estimate_scan(read_cloud(folder_ / "scan.xyz").points);
  char option[64];
  std::snprintf(option, sizeof option, "--max-error %.2g ", *suggested_tolerance(scan));
  const ProgramRun run = emax({"optimize", "scan.xyz", "-o", "mesh.ply"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find(option), std::string::npos) << run.errors;
  EXPECT_EQ(emax({"optimize", "scan.xyz"}).errors, run.errors);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "mesh.ply.run"));
  const ProgramRun without = emax({"optimize", "scan.xyz", "--max-error", "1%"});
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_NE(without.errors.find("--output is required"), std::string::npos) << without.errors;
}

}  // namespace
}  // namespace emax
