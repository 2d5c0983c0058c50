#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "tests/host/app/program.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using test::ProgramRun;

class BadInput : public testing::Test {
 protected:
  BadInput() {
    test::write_scan(folder_.path() / "scan.xyz", 400, 1);
    test::write_surface(folder_.path() / "surface.off", 8, 10);
    before_ = test::files_in(folder_.path());
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    before_ = test::files_in(folder_.path());
  }

  ProgramRun optimize(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "optimize");
    return test::run_emax(arguments, folder_.path());
  }

  // One line that holds every one of `words`; exit code 1; no file more than before.
  void expect_refusal(const ProgramRun& run, const std::vector<std::string>& words) {
    EXPECT_EQ(run.exit_code, 1) << run.errors;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    EXPECT_TRUE(run.errors.starts_with("emax: ")) << run.errors;
    for (const std::string& word : words) {
      EXPECT_NE(run.errors.find(word), std::string::npos)
          << "no '" << word << "' in " << run.errors;
    }
    EXPECT_EQ(test::files_in(folder_.path()), before_);
  }

  void expect_cloud_refused(const std::string& name, const std::vector<std::string>& words) {
    SCOPED_TRACE(name);
    std::vector<std::string> all = words;
    all.push_back(name);
    expect_refusal(optimize({name, "--max-error", "1%", "-o", "out.ply"}), all);
    expect_refusal(test::run_emax({"error", name, "surface.off"}, folder_.path()), all);
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> before_;
};

TEST_F(BadInput, CloudFiles) {
  write("empty.xyz", "");
  write("nan.xyz", "0 0 0\n1 nan 0\n0 1 0\n0 0 1\n1 1 1\n");
  write("three.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  write("equal.xyz", "1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n");
  write("line.xyz", "0 0 0\n1 1 1\n2 2 2\n3 3 3\n4 4 4\n");
  write("words.xyz", "0 0 0\n1 0 0\nfour five six\n");
  write("garbage.ply", std::string("\x7f"
                                   "ELF\0\1\2\3 what is this",
                                   20));
  write("truncated.off", "OFF\n5 0 0\n0 0 0\n1 0 0\n");
  write("picture.png", "not a cloud");
  expect_cloud_refused("missing.ply", {});
  expect_cloud_refused("empty.xyz", {});
  expect_cloud_refused("nan.xyz", {"--skip-invalid"});
  expect_cloud_refused("three.xyz", {"4"});
  expect_cloud_refused("equal.xyz", {});
  expect_cloud_refused("line.xyz", {});
  expect_cloud_refused("words.xyz", {"3"});
  expect_cloud_refused("garbage.ply", {});
  expect_cloud_refused("truncated.off", {});
  expect_cloud_refused("picture.png", {".ply"});
  expect_cloud_refused(".", {});
}

TEST_F(BadInput, Tolerances) {
  for (const char* bad : {"0", "-1", "nan", "inf", "0%", "-2%", "5mm", "1 %", "", "%", "1e999"}) {
    SCOPED_TRACE(bad);
    expect_refusal(optimize({"scan.xyz", "--max-error", bad, "-o", "out.ply"}), {"--max-error"});
    expect_refusal(
        test::run_emax({"error", "scan.xyz", "surface.off", "--max-error", bad}, folder_.path()),
        {"--max-error"});
  }
  for (const char* wrong_unit : {"500", "100%"}) {
    expect_refusal(optimize({"scan.xyz", "--max-error", wrong_unit, "-o", "out.ply"}),
                   {"--max-error", "width of scan.xyz", "unit"});
  }
}

TEST_F(BadInput, Outputs) {
  const auto to = [this](const std::string& name) {
    return optimize({"scan.xyz", "--max-error", "1%", "-o", name});
  };
  expect_refusal(to("no/such/folder/out.ply"), {"no/such/folder"});
  expect_refusal(to("out.step"), {"out.step", ".ply"});
  expect_refusal(to("out"), {"out", ".ply"});
  expect_refusal(to("/proc/out.ply"), {"/proc"});
  expect_refusal(optimize({"scan.xyz", "--max-error", "1%", "-o", "out.ply", "--json", "a.txt"}),
                 {"a.txt", ".json"});
  // What is written beside the mesh is tried before anything takes long.
  for (const char* taken : {"out.ply.certificate.json", "out.ply.reference.ply"}) {
    std::filesystem::create_directory(folder_ / taken);
    before_ = test::files_in(folder_.path());
    expect_refusal(to("out.ply"), {taken, "is a folder"});
    expect_refusal(test::run_emax({"decimate", "surface.off", "--max-error", "1%", "-o", "out.ply"},
                                  folder_.path()),
                   {taken, "is a folder"});
    std::filesystem::remove(folder_ / taken);
  }
  before_ = test::files_in(folder_.path());
  expect_refusal(optimize({"scan.xyz", "--max-error", "1%", "-o", "m\xfc.ply"}),
                 {"m?.ply", "UTF-8"});
  std::filesystem::create_directory(folder_ / "night");
  before_ = test::files_in(folder_.path());
  expect_refusal(
      optimize({"scan.xyz", "--max-error", "1%", "-o", "night/mesh-5.ply", "--resume", "./night"}),
      {"night/mesh-5.ply", "run's own files"});
}

TEST_F(BadInput, OutputsThatWouldReplaceWhatIsReadOrWritten) {
  std::filesystem::create_symlink("scan.xyz", folder_ / "link.ply");
  write("scan.ply", "ply");
  write("scan.off.reference.ply", "ply");
  const auto to = [this](const std::string& cloud, const std::string& output,
                         const std::string& json) {
    return optimize({cloud, "--max-error", "1%", "-o", output, "--json", json});
  };
  expect_refusal(to("scan.ply", "./scan.ply", "r.json"),
                 {"./scan.ply: would be read and replaced"});
  expect_refusal(to("scan.xyz", "link.ply", "r.json"), {"link.ply: would be read and replaced"});
  expect_refusal(to("scan.off.reference.ply", "scan.off", "r.json"),
                 {"scan.off.reference.ply: would be read and replaced"});
  expect_refusal(to("scan.xyz", "./a.ply", "a.ply.certificate.json"),
                 {"a.ply.certificate.json: would be written twice"});
  expect_refusal(to("scan.xyz", "a.ply", (folder_ / "a.ply.certificate.json").string()),
                 {"a.ply.certificate.json: would be written twice"});
  expect_refusal(to("scan.xyz", "a.ply", "a.ply.certificate.json"),
                 {"a.ply.certificate.json: would be written twice"});
  const auto color = [this](const std::string& cloud, const std::string& mesh) {
    return test::run_emax(
        {"error", "scan.ply", "surface.off", "--two-sided", "--color", cloud, "--color-mesh", mesh},
        folder_.path());
  };
  expect_refusal(color("scan.ply", "m.ply"), {"scan.ply: would be read and replaced"});
  expect_refusal(color("m.ply", "m.ply"), {"m.ply: would be written twice"});
}

TEST_F(BadInput, Options) {
  expect_refusal(optimize({"scan.xyz", "-o", "out.ply"}), {"--max-error"});
  const auto with = [this](const std::string& option, const std::string& value) {
    return optimize({"scan.xyz", "--max-error", "1%", "-o", "out.ply", option, value});
  };
  expect_refusal(with("--method", "magic"), {"gp3"});
  expect_refusal(with("--decimator", "magic"), {"schroeder"});
  expect_refusal(with("--bound", "both"), {"one-sided"});
  expect_refusal(optimize({"scan.xyz", "--max-error", "1%", "-o", "out.ply", "--decimator",
                           "schroeder", "--bound", "two-sided"}),
                 {"bounded"});
  expect_refusal(optimize({"scan.xyz", "--max-error", "1%", "-o", "out.ply", "--decimator",
                           "schroeder", "--features", "auto"}),
                 {"--features", "bounded"});
  expect_refusal(optimize({"scan.xyz", "--max-error", "1%", "-o", "out.ply", "--tiles", "1000",
                           "--features", "auto"}),
                 {"--tiles", "--features"});
  expect_refusal(with("--features", "walls"), {"planes"});
  expect_refusal(with("--hole-reach", "1%"), {"--hole-reach", "--features"});
  expect_refusal(with("--device", "toaster"), {"toaster", "cpu", "sim", "rtl"});
  expect_refusal(with("--device", "sim:board=toaster"), {"toaster", "ulx3s"});
  expect_refusal(with("--device", "opencl:99"), {"opencl:99", "use opencl:0"});
  setenv("OCL_ICD_VENDORS", folder_.path().c_str(), 1);  // where no driver is
  expect_refusal(with("--device", "opencl"), {"no OpenCL device", "pocl-opencl-icd"});
  unsetenv("OCL_ICD_VENDORS");
  expect_refusal(with("--device", "xrt:none.xclbin"), {"xrt:none.xclbin"});
  expect_refusal(with("--budget", "0"), {"--budget"});
  expect_refusal(with("--jobs", "-1"), {"--jobs"});
  expect_refusal(with("--time", "soon"), {"--time"});
  for (const char* bad : {"0", "-1", "nan", "inf", ""}) {
    expect_refusal(with("--time", bad), {"--time", "optimize --help"});
    expect_refusal(with("--evaluation-time", bad), {"--evaluation-time"});
    expect_refusal(with("--stagnation", bad), {"--stagnation"});
  }
  for (const char* bad : {"x", "-1", "1.5", "18446744073709551616"}) {
    expect_refusal(with("--seed", bad), {"--seed"});
  }
  expect_refusal(with("--evaluation-memory", "-1"), {"--evaluation-memory", "negative"});
  expect_refusal(with("--resume", ""), {"--resume", "empty"});
  expect_refusal(
      test::run_emax({"error", "scan.xyz", "surface.off", "--quantile", "nan"}, folder_.path()),
      {"--quantile", "0 to 100"});
  expect_refusal(test::run_emax({"optimise", "scan.xyz"}, folder_.path()),
                 {"optimise", "did you mean optimize?", "optimize, reconstruct, decimate"});
  expect_refusal(optimize({"scan.xyz", "--max-eror", "1%", "-o", "out.ply"}),
                 {"--max-eror", "did you mean --max-error?", "optimize --help"});
  expect_refusal(with("--exclude-outliers", "1.5"), {"--exclude-outliers"});
  expect_refusal(with("--config", "none.toml"), {"none.toml"});
  write("bad.toml", "[search]\nbudgett = 3\n");
  expect_refusal(with("--config", "bad.toml"), {"bad.toml", "budgett"});
}

TEST_F(BadInput, Meshes) {
  write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  write("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
  for (const char* mesh : {"missing.off", "open.off", "scan.xyz"}) {
    expect_refusal(test::run_emax({"error", "scan.xyz", mesh}, folder_.path()), {mesh});
  }
  expect_refusal(test::run_emax({"error", "scan.xyz", "none.off"}, folder_.path()), {"triangles"});
}

TEST_F(BadInput, Certificates) {
  write("not.json", "{]");
  write("other.json", "{\"schema\": \"something else\"}");
  for (const char* name : {"missing.json", "not.json", "other.json", "."}) {
    expect_refusal(test::run_emax({"verify", name}, folder_.path()), {name});
  }
}

// STL holds 32 bits: far from the origin it would move vertices by more than epsilon / 100.
TEST_F(BadInput, StlThatWouldRoundTooMuch) {
  std::ifstream scan(folder_.path() / "scan.xyz");
  std::string far;
  for (double x, y, z; scan >> x >> y >> z;) {
    far += std::to_string(1e7 + x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  }
  write("far.xyz", far);
  expect_refusal(optimize({"far.xyz", "--max-error", "5%", "-o", "out.stl", "--budget", "4"}),
                 {"out.stl", ".ply"});
}

TEST_F(BadInput, NothingAtAll) {
  const ProgramRun run = test::run_emax({}, folder_.path());
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("optimize"), std::string::npos);
  EXPECT_TRUE(test::run_emax({"--version"}, folder_.path()).output.starts_with("emax "));
}

// Closed streams and full ones cost what would be shown there, and nothing else.
TEST_F(BadInput, StandardStreamsThatCannotBeWritten) {
  const auto shell = [this](const std::string& arguments) {
    const std::string command =
        "cd '" + folder_.path().string() + "' && " EMAX_PROGRAM " " + arguments;
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  };
  const std::string decimate = "decimate surface.off --max-error 5% -o out.ply ";
  EXPECT_EQ(shell(decimate + ">&- 2>&-"), 0);
  EXPECT_EQ(shell(decimate + ">/dev/null 2>/dev/full"), 0);
  EXPECT_EQ(shell("verify out.ply.certificate.json >/dev/null 2>&-"), 0);
  EXPECT_EQ(shell("error missing.xyz surface.off >/dev/null 2>/dev/full"), 1);
  EXPECT_EQ(shell("error scan.xyz surface.off >/dev/full 2>/dev/null"), 1);
  const std::string search =
      "optimize scan.xyz --max-error 20% -o out.ply --budget 2 --no-polish --resume night ";
  EXPECT_EQ(shell(search + ">&- 2>&-"), 0);
  const ProgramRun again =
      test::run_emax({"optimize", "scan.xyz", "--max-error", "20%", "-o", "out.ply", "--budget",
                      "2", "--no-polish", "--resume", "night"},
                     folder_.path());
  EXPECT_NE(again.output.find("night: 2 of 2 evaluations are there\n"), std::string::npos)
      << again.output;
}

}  // namespace
}  // namespace emax
