// --json of every command: into a file, or on standard output with the text on standard error.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/host/app/program.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;
using Arguments = std::vector<std::string>;

class JsonOutput : public testing::Test {
 protected:
  JsonOutput() {
    test::write_scan(folder_ / "scan.xyz", 400, 2);
    test::write_surface(folder_ / "surface.off", 12, 16);
  }

  ProgramRun emax(Arguments arguments, const Arguments& more = {}) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_emax(arguments, folder_.path());
  }

  // The command gives the same JSON in both places, and the same text beside it.
  void expect_json(const Arguments& command, int exit_code, const std::string& schema,
                   const std::string& word) {
    SCOPED_TRACE(command.front());
    const ProgramRun with_file = emax(command, {"--json", "r.json"});
    EXPECT_EQ(with_file.exit_code, exit_code) << with_file.errors;
    EXPECT_NE(with_file.output.find(word), std::string::npos) << with_file.output;
    const std::string text = test::file_text(folder_ / "r.json");
    EXPECT_EQ(json::parse(text).at("schema"), schema);
    for (const Arguments& to_output : {Arguments{"--json", "-"}, Arguments{"--json=-"}}) {
      const ProgramRun with_output = emax(command, to_output);
      EXPECT_EQ(with_output.exit_code, exit_code) << with_output.errors;
      EXPECT_EQ(with_output.output, text);
      EXPECT_NE(with_output.errors.find(word), std::string::npos) << with_output.errors;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "-"));
  }

  test::TemporaryFolder folder_;
};

TEST_F(JsonOutput, EveryCommandWritesTheSameToAFileAndToStandardOutput) {
  expect_json({"decimate", "surface.off", "--max-error", "5%", "-o", "small.ply"}, 0,
              "emax-result-1", "certificate    small.ply");
  expect_json({"error", "scan.xyz", "surface.off", "--max-error", "50%"}, 0, "emax-result-1",
              "cloud to mesh");
  expect_json({"error", "scan.xyz", "surface.off", "--max-error", "1e-9"}, 2, "emax-result-1",
              "exceeded");
  expect_json({"verify", "small.ply.certificate.json"}, 0, "emax-verification-1", "yes: every");
  expect_json({"optimize", "scan.xyz", "--max-error", "20%", "-o", "mesh.ply", "--budget", "2",
               "--no-polish", "--jobs", "1"},
              0, "emax-result-1", "certificate    mesh.ply");
}

TEST_F(JsonOutput, AVerificationSaysWhatItFound) {
  ASSERT_EQ(emax({"decimate", "surface.off", "--max-error", "5%", "-o", "small.ply"}).exit_code, 0);
  const std::string name = "small.ply.certificate.json";
  const json certificate = json::parse(test::file_text(folder_ / name));
  const auto verification = [&](int exit_code) {
    const ProgramRun run = emax({"verify", name, "--json", "-"});
    EXPECT_EQ(run.exit_code, exit_code) << run.errors;
    return json::parse(run.output);
  };
  const json good = verification(0);
  EXPECT_EQ(good.at("holds"), true);
  EXPECT_EQ(good.at("reasons"), json::array());
  for (const char* key : {"e_max", "epsilon", "triangles", "points", "topology", "reference"}) {
    EXPECT_EQ(good.at(key), certificate.at(key)) << key;
  }
  EXPECT_EQ(good.at("certificate"), name);
  EXPECT_EQ(good.at("mesh"), "small.ply");
  EXPECT_EQ(good.at("cloud"), "surface.off");
  std::ofstream(folder_ / "small.ply", std::ios::app) << "x";
  const json bad = verification(2);
  EXPECT_EQ(bad.at("holds"), false);
  EXPECT_EQ(bad.at("reasons").size(), 1u);
  EXPECT_TRUE(bad.at("e_max").is_null());
}

TEST_F(JsonOutput, RefusesWhatItCannotWrite) {
  ASSERT_EQ(emax({"decimate", "surface.off", "--max-error", "5%", "-o", "small.ply"}).exit_code, 0);
  const auto refused = [&](const Arguments& arguments, const std::string& word) {
    const ProgramRun run = emax(arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.output, "");
    EXPECT_NE(run.errors.find(word), std::string::npos) << run.errors;
  };
  refused({"verify", "small.ply.certificate.json", "--json", "r.txt"}, "r.txt");
  refused({"verify", "small.ply.certificate.json", "--json", "small.ply.certificate.json"},
          "would be read and replaced");
  refused({"error", "missing.xyz", "surface.off", "--json", "-"}, "missing.xyz");
  const std::string command = "cd '" + folder_.path().string() +
                              "' && " EMAX_PROGRAM " error scan.xyz surface.off --json - ";
  const auto exit_code = [&](const std::string& streams) {
    return WEXITSTATUS(std::system((command + streams).c_str()));
  };
  EXPECT_EQ(exit_code(">/dev/full 2>/dev/null"), 1);
  EXPECT_EQ(exit_code(">/dev/null 2>/dev/full"), 0) << "text alone is lost";
  EXPECT_EQ(exit_code(">/dev/null 2>&-"), 0);
}

}  // namespace
}  // namespace emax
