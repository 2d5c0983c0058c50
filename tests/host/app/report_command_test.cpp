// --report and --picture of each command, as a person gives them and a browser reads them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/files/sha256.h"
#include "tests/host/app/program.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using nlohmann::json;
using test::ProgramRun;
using Arguments = std::vector<std::string>;

class ReportCommand : public testing::Test {
 protected:
  ReportCommand() {
    test::write_scan(folder_ / "scan.xyz", 1200, 2);
    test::write_surface(folder_ / "surface.off", 14, 18);
  }

  ProgramRun emax(const Arguments& arguments) { return test::run_emax(arguments, folder_.path()); }
  std::string text(const std::string& name) { return test::file_text(folder_ / name); }
  bool exists(const std::string& name) { return std::filesystem::exists(folder_ / name); }

  json report(const std::string& name) {
    const std::string page = text(name), begin = "id=\"emax-data\">";
    const std::size_t at = page.find(begin);
    if (at == std::string::npos) return {};
    const std::size_t from = at + begin.size();
    return json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  // What every report says, whatever the command.
  void expect_whole(const json& data, const std::string& command, const std::string& title) {
    ASSERT_TRUE(data.is_object()) << command;
    EXPECT_EQ(data.at("schema"), "emax-report-1");
    EXPECT_EQ(data.at("command"), command);
    EXPECT_EQ(data.at("title"), title);
    EXPECT_EQ(data.at("signed"), true);
    EXPECT_EQ(data.at("worst").size(), 20u);
    EXPECT_EQ(std::abs(data.at("worst").at(0).at("deviation").get<double>()), data.at("e_max"));
    EXPECT_EQ(data.at("statistics").at("count"), data.at("points"));
    for (const json& input : data.at("provenance")) {
      EXPECT_EQ(input.at("sha256"), sha256_of_file(folder_ / input.at("file").get<std::string>()));
    }
    EXPECT_FALSE(data.at("times").empty());
  }

  int shell(const std::string& command) {
    const int status = std::system(("cd '" + folder_.path().string() + "' && " + command).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReportCommand, OfErrorSaysWhatItsJsonSays) {
  const ProgramRun run =
      emax({"error", "scan.xyz", "surface.off", "--max-error", "1%", "--unit", "mm", "--json",
            "r.json", "--report", "r.html", "--picture", "r.png"});
  EXPECT_EQ(run.exit_code, 2) << run.errors;
  EXPECT_NE(run.output.find("\nreport         r.html: open it in a browser\n"), std::string::npos);
  EXPECT_NE(run.output.find("\npicture        r.png\n"), std::string::npos);
  const json data = report("r.html"), result = json::parse(text("r.json"));
  expect_whole(data, "error", "surface.off");
  EXPECT_EQ(data.at("unit"), "mm");
  EXPECT_EQ(data.at("verdict").at("within"), false);
  EXPECT_EQ(data.at("e_max"), result.at("e_max"));
  EXPECT_EQ(data.at("epsilon"), result.at("epsilon"));
  const json& statistics = data.at("statistics");
  EXPECT_EQ(statistics.at("above").get<int>() + statistics.at("below").get<int>(),
            result.at("errors").at("cloud_to_mesh").at("exceeding"));
  for (std::size_t i = 0; i < 5; ++i) {
    const json& there = data.at("worst").at(i);
    const json& here = result.at("errors").at("worst_points").at(i);
    EXPECT_EQ(there.at("point"), here.at("point"));
    EXPECT_EQ(there.at("triangle"), here.at("triangle"));
    EXPECT_EQ(std::abs(there.at("deviation").get<double>()), here.at("distance"));
  }
  EXPECT_EQ(result.at("report"), "r.html");
  EXPECT_EQ(result.at("picture"), "r.png");
  EXPECT_TRUE(text("r.png").starts_with("\x89PNG"));
  for (const json& fact : data.at("facts")) {
    const std::string name = fact.at("name");
    EXPECT_NE(run.output.find(name + std::string(15 - name.size(), ' ') +
                              fact.at("text").get<std::string>()),
              std::string::npos)
        << fact;
  }
}

TEST_F(ReportCommand, SameInputsGiveTheSameBytesButForTimes) {
  std::string before;
  for (const char* name : {"a.html", "b.html"}) {
    ASSERT_EQ(emax({"error", "scan.xyz", "surface.off", "--report", name}).exit_code, 0);
    std::string page = text(name);
    const std::size_t at = page.find("\"times\":"), end = page.find("</script>", at);
    ASSERT_NE(at, std::string::npos);
    page.erase(at, end - at);
    EXPECT_TRUE(before.empty() || page == before);
    before = page;
  }
}

TEST_F(ReportCommand, OfDecimateHoldsTheCertificateAndTheCommandThatVerifiesIt) {
  const ProgramRun run = emax({"decimate", "surface.off", "--max-error", "2%", "-o", "small.ply",
                               "--report", "small.html", "--effort", "quick"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json data = report("small.html");
  expect_whole(data, "decimate", "small.ply");
  EXPECT_EQ(data.at("verdict").at("within"), true);
  EXPECT_EQ(data.at("certificate").at("text"), text("small.ply.certificate.json"));
  EXPECT_EQ(data.at("curve"), nullptr);
  const json certificate = json::parse(text("small.ply.certificate.json"));
  EXPECT_EQ(data.at("back"), certificate.at("reference").at("mesh_to_reference"));
  std::istringstream words(data.at("certificate").at("verify").get<std::string>());
  std::string word;
  words >> word;
  EXPECT_EQ(word, "emax");
  Arguments arguments;
  while (words >> word) arguments.push_back(word);
  EXPECT_EQ(emax(arguments).exit_code, 0);
}

TEST_F(ReportCommand, OfSeveralTolerancesIsOneForEachWithTheCurve) {
  const ProgramRun run =
      emax({"decimate", "surface.off", "--max-error", "5%,1%", "-o", "small.ply", "--report",
            "r.html", "--picture", "p.png", "--effort", "quick", "--json", "r.json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json rows = json::parse(text("r.json")).at("curve");
  for (const std::string label : {"1pct", "5pct"}) {
    const json data = report("r-" + label + ".html");
    expect_whole(data, "decimate", "small-" + label + ".ply");
    ASSERT_EQ(data.at("curve").size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(data.at("curve").at(i).at("triangles"), rows.at(i).at("triangles"));
      EXPECT_EQ(data.at("curve").at(i).at("epsilon"), rows.at(i).at("epsilon"));
    }
    EXPECT_TRUE(exists("p-" + label + ".png"));
    EXPECT_NE(run.output.find("r-" + label + ".html: open it"), std::string::npos) << run.output;
  }
  EXPECT_EQ(rows.at(0).at("report"), "r-1pct.html");
  EXPECT_EQ(rows.at(1).at("picture"), "p-5pct.png");
  EXPECT_FALSE(exists("r.html"));
}

TEST_F(ReportCommand, OfVerifyAnswersEveryClaim) {
  ASSERT_EQ(
      emax({"decimate", "surface.off", "--max-error", "2%", "-o", "small.ply", "--effort", "quick"})
          .exit_code,
      0);
  const Arguments verify = {"verify", "small.ply.certificate.json", "--report", "v.html", "--json",
                            "v.json"};
  EXPECT_EQ(emax(verify).exit_code, 0);
  json data = report("v.html");
  expect_whole(data, "verify", "small.ply.certificate.json");
  EXPECT_EQ(data.at("verdict").at("within"), true);
  EXPECT_GE(data.at("checks").size(), 8u);
  for (const json& check : data.at("checks")) EXPECT_EQ(check.at("holds"), true) << check;
  EXPECT_EQ(json::parse(text("v.json")).at("report"), "v.html");

  // A mesh that was changed after its certificate was written.
  std::string mesh = text("small.ply");
  mesh[mesh.size() / 2] ^= 1;
  folder_.write("small.ply", mesh);
  EXPECT_EQ(emax(verify).exit_code, 2);
  data = report("v.html");
  EXPECT_EQ(data.at("verdict").at("within"), false);
  EXPECT_EQ(data.at("checks").at(0).at("holds"), false);
}

TEST_F(ReportCommand, OfASearchHasItsEvaluations) {
  const ProgramRun run =
      emax({"optimize", "scan.xyz", "--max-error", "5%", "-o", "mesh.ply", "--budget", "3",
            "--no-polish", "--report", "r.html", "--picture", "r.png", "--json", "r.json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json data = report("r.html"), result = json::parse(text("r.json"));
  expect_whole(data, "optimize", "mesh.ply");
  EXPECT_EQ(data.at("triangles"), result.at("triangles"));
  EXPECT_EQ(data.at("certificate").at("text"), text("mesh.ply.certificate.json"));
  const json& evaluations = data.at("search").at("evaluations");
  ASSERT_EQ(evaluations.size(), 3u);
  std::size_t fewest = ~std::size_t{0};
  for (const json& e : evaluations) {
    if (e.at("feasible") == true) fewest = std::min(fewest, e.at("triangles").get<std::size_t>());
  }
  EXPECT_EQ(fewest, data.at("triangles"));
  EXPECT_EQ(result.at("report"), "r.html");
}

TEST_F(ReportCommand, OfAnInterruptedSearchShowsTheBestSoFar) {
  test::EmaxProcess process({"optimize", "scan.xyz", "--max-error", "5%", "-o", "mesh.ply",
                             "--budget", "100000", "--report", "r.html"},
                            folder_.path());
  process.await_output("certified and written");
  process.signal(SIGINT);
  const ProgramRun run = process.wait();
  EXPECT_EQ(run.exit_code, 130) << run.errors;
  const json data = report("r.html");
  expect_whole(data, "optimize", "mesh.ply");
  EXPECT_EQ(data.at("verdict").at("within"), true);
  EXPECT_EQ(data.at("certificate").at("text"), text("mesh.ply.certificate.json"));
}

TEST_F(ReportCommand, OutliersAreListedApart) {
  ASSERT_NE(
      emax({"error", "scan.xyz", "surface.off", "--exclude-outliers", "1%", "--report", "r.html"})
          .exit_code,
      1);
  const json data = report("r.html");
  EXPECT_EQ(data.at("excluded_count"), 12);
  EXPECT_EQ(data.at("excluded").size(), 12u);
  EXPECT_EQ(data.at("points"), 1188);
  EXPECT_EQ(data.at("geometry").at("points"), 1188);
  const double least = std::abs(data.at("excluded").at(11).at("deviation").get<double>());
  EXPECT_GE(least, std::abs(data.at("worst").at(0).at("deviation").get<double>()));
}

TEST_F(ReportCommand, RefusesBeforeTheWork) {
  std::filesystem::create_symlink("scan.xyz", folder_ / "scan.html");
  const auto refused = [&](const Arguments& more, const std::string& word) {
    Arguments arguments = {"error", "scan.xyz", "surface.off"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = emax(arguments);
    EXPECT_EQ(run.exit_code, 1) << word;
    EXPECT_EQ(run.output, "");
    EXPECT_NE(run.errors.find(word), std::string::npos) << run.errors;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
  };
  refused({"--report", "r.pdf"}, "r.pdf: unknown ending");
  refused({"--picture", "r.jpg"}, "r.jpg: unknown ending");
  refused({"--report", "nowhere/r.html"}, "does not exist");
  refused({"--picture", "/proc/r.png"}, "cannot be written");
  refused({"--report", "scan.html"}, "would be read and replaced");
  refused({"--report", ""}, "--report");
  EXPECT_EQ(test::files_in(folder_.path()).size(), 3u);
  for (const char* command : {"optimize", "decimate", "verify"}) {
    EXPECT_EQ(emax({command, "scan.xyz", "--max-error", "1%", "-o", "m.ply", "--report", "r.txt"})
                  .exit_code,
              1);
  }
  EXPECT_NE(emax({"optimize", "scan.xyz", "--max-error", "1%", "-o", "m.ply", "--report",
                  "m.ply.run/r.html"})
                .errors.find("m.ply.run"),
            std::string::npos);
}

// A limit on the size of files stands in for the full disk.
TEST_F(ReportCommand, AFullDiskLeavesNeitherPageNorPicture) {
  EXPECT_EQ(shell("trap '' XFSZ; ulimit -f 4; " EMAX_PROGRAM
                  " error scan.xyz surface.off --picture r.png --report r.html >/dev/null 2>err"),
            1);
  EXPECT_NE(text("err").find("r.html: cannot be written"), std::string::npos) << text("err");
  EXPECT_FALSE(exists("r.html"));
  EXPECT_FALSE(exists("r.png"));
  EXPECT_EQ(test::files_in(folder_.path()), (Arguments{"err", "scan.xyz", "surface.off"}));
}

}  // namespace
}  // namespace emax
