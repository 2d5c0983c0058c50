#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/host/app/program.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using test::ProgramRun;

class Resume : public testing::Test {
 protected:
  Resume() { test::write_scan(folder_.path() / "scan.xyz", 600, 2); }

  static std::vector<std::string> command(const std::vector<std::string>& more,
                                          const std::string& output = "mesh.ply",
                                          const std::string& budget = "20") {
    std::vector<std::string> arguments = {"optimize", "scan.xyz", "--max-error", "5%",
                                          "-o",       output,     "--budget",    budget};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  ProgramRun optimize(const std::vector<std::string>& more = {}) {
    return test::run_emax(command(more), folder_.path());
  }
  bool exists(const std::string& name) { return std::filesystem::exists(folder_.path() / name); }
  std::string result() {
    return test::bytes_of(folder_ / "mesh.ply") +
           test::bytes_of(folder_ / "mesh.ply.certificate.json");
  }
  static std::string first_line(const ProgramRun& run) {
    return run.output.substr(0, run.output.find('\n'));
  }
  // Of a certificate, which may be replaced meanwhile.
  std::size_t triangles_in(const std::string& name) {
    const auto certificate = nlohmann::json::parse(test::file_text(folder_ / name), nullptr, false);
    return certificate.is_discarded() ? 0 : certificate.at("triangles").get<std::size_t>();
  }
  // Waits until so many bytes are in a log.
  void await(const std::string& log, std::uintmax_t bytes) {
    std::error_code absent;
    for (int i = 0; i < 300'000; ++i) {
      const std::uintmax_t size = std::filesystem::file_size(folder_ / log, absent);
      if (!absent && size >= bytes) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << log << " does not grow";
  }

  test::TemporaryFolder folder_;
};

TEST_F(Resume, AFolderIsCreatedAndContinued) {
  const ProgramRun first = optimize({"--resume", "night"});
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_EQ(first_line(first), "run            starts in night");
  const std::string expected = result();
  std::filesystem::remove(folder_ / "mesh.ply");
  const ProgramRun again = optimize({"--resume", "night", "--jobs", "1"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(first_line(again), "run            continues in night: 20 of 20 evaluations are there");
  EXPECT_EQ(result(), expected);
}

// The evaluations that are there serve a larger budget, and the end is the same however often and
// wherever the run was cut on its way, as the budgets one after the other decide it.
TEST_F(Resume, ALargerBudgetGoesOnFromTheFolder) {
  const auto with = [this](const std::string& budget, const std::string& folder) {
    const ProgramRun run =
        test::run_emax(command({"--resume", folder}, "mesh.ply", budget), folder_.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return run;
  };
  with("20", "night");
  const ProgramRun more = with("40", "night");
  EXPECT_EQ(first_line(more), "run            continues in night: 20 of 40 evaluations are there");
  const std::string expected = result();

  test::EmaxProcess process(command({"--resume", "day"}, "mesh.ply", "20"), folder_.path());
  await("day/evaluations.log", 1000);
  process.signal(SIGKILL);
  process.wait();
  with("40", "day");
  EXPECT_EQ(result(), expected);
  // What is there already is more than enough for a smaller one.
  EXPECT_NE(with("10", "day").output.find("evaluations    10 in"), std::string::npos);
  with("40", "day");
  EXPECT_EQ(result(), expected);
}

TEST_F(Resume, WhatDiffersIsNamed) {
  ASSERT_EQ(optimize({"--resume", "night"}).exit_code, 0);
  const std::string expected = result();
  const auto refusal = [this](const std::vector<std::string>& more, const std::string& what) {
    std::vector<std::string> arguments = {"--resume", "night"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = optimize(arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find("night: the run there has " + what), std::string::npos) << run.errors;
  };
  refusal({"--seed", "2"}, "seed 1, this one has 2");
  refusal({"--method", "hoppe"}, "method fit, this one has hoppe");
  // The paper's decimation has no reference to fit.
  refusal({"--decimator", "schroeder"}, "method fit, this one has gp3");
  refusal({"--bound", "one-sided"}, "bound two-sided, this one has one-sided");
  refusal({"--exclude-outliers", "1%"}, "exclude_outliers 0, this one has 0.01");
  folder_.write("narrow.toml", "[genes.\"bounded.flatness\"]\nupper = 0.005\n");
  refusal({"--config", "narrow.toml"}, "genes.bounded.flatness ");
  // As if another program had made another reference.
  const std::string settings = test::file_text(folder_ / "night" / "settings.json");
  std::string other = settings;
  const std::size_t digit = other.find("reference.sha256\": \"") + 20;
  other[digit] = other[digit] == '0' ? '1' : '0';
  folder_.write("night/settings.json", other);
  refusal({}, "reference.sha256 ");
  folder_.write("night/settings.json", settings);
  std::ofstream(folder_ / "scan.xyz", std::ios::app) << "0 0 1.01\n";
  refusal({}, "cloud.sha256 ");
  EXPECT_EQ(result(), expected);
}

TEST_F(Resume, ASecondProcessIsRefused) {
  const auto endless = command({"--resume", "night"}, "mesh.ply", "100000");
  test::EmaxProcess first(endless, folder_.path());
  await("night/evaluations.log", 1000);
  const ProgramRun second = test::run_emax(endless, folder_.path());
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.errors.find("night: another process"), std::string::npos) << second.errors;
  first.signal(SIGKILL);
  EXPECT_EQ(first.wait().exit_code, 128 + SIGKILL);
}

// Without --resume the folder stands beside the mesh while it is needed.
TEST_F(Resume, AnInterruptedRunIsContinuedByTheSameCommand) {
  const auto arguments = command({"--jobs", "1"}, "mesh.ply", "40");
  ASSERT_EQ(test::run_emax(arguments, folder_.path()).exit_code, 0);
  EXPECT_FALSE(exists("mesh.ply.run"));
  const std::string expected = result();
  std::filesystem::remove(folder_ / "mesh.ply");
  std::filesystem::remove(folder_ / "mesh.ply.certificate.json");

  test::EmaxProcess process(arguments, folder_.path());
  await("mesh.ply.run/evaluations.log", 1000);
  process.signal(SIGINT);
  const ProgramRun cut = process.wait();
  EXPECT_EQ(cut.exit_code, 130) << cut.errors;
  EXPECT_NE(cut.output.find("mesh.ply.run; the same command continues it"), std::string::npos)
      << cut.output;
  ASSERT_TRUE(exists("mesh.ply.run"));
  const ProgramRun rest = test::run_emax(arguments, folder_.path());
  ASSERT_EQ(rest.exit_code, 0) << rest.errors;
  EXPECT_TRUE(first_line(rest).starts_with("run            continues in mesh.ply.run: "));
  EXPECT_EQ(result(), expected);
  EXPECT_FALSE(exists("mesh.ply.run"));
}

// A signal ends a search with the best mesh so far, written and true; a second one, before anything
// new was evaluated, writes nothing and says where the evaluations are.
TEST_F(Resume, ASignalWritesTheBestSoFar) {
  const auto endless = command({"--resume", "night"}, "mesh.ply", "100000");
  for (const int number : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(folder_ / "night");
    std::filesystem::remove(folder_ / "mesh.ply");
    test::EmaxProcess process(endless, folder_.path());
    await("night/evaluations.log", 1000);
    process.signal(number);
    const ProgramRun cut = process.wait();
    EXPECT_EQ(cut.exit_code, 130) << cut.errors;
    EXPECT_NE(cut.output.find("night; the same command continues it"), std::string::npos)
        << cut.output;
    EXPECT_TRUE(exists("mesh.ply"));
    EXPECT_EQ(test::run_emax({"verify", "mesh.ply.certificate.json"}, folder_.path()).exit_code, 0);
  }
  test::EmaxProcess process(endless, folder_.path());
  process.await_output("continues in night");
  process.signal(SIGINT);
  const ProgramRun cut = process.wait();
  EXPECT_EQ(cut.exit_code, 130) << cut.errors;
  EXPECT_NE(cut.output.find("night; the same command continues it"), std::string::npos)
      << cut.output;
}

// From the reference on there is a certified mesh, whatever ends the program and when, and better
// ones take its place.
TEST_F(Resume, AKilledSearchLeavesACertifiedMesh) {
  const auto endless = command({"--resume", "night"}, "mesh.ply", "100000");
  const auto kill_and_count = [&](const std::function<void(test::EmaxProcess&)>& until) {
    test::EmaxProcess process(endless, folder_.path());
    until(process);
    process.signal(SIGKILL);
    process.wait();
    EXPECT_EQ(test::run_emax({"verify", "mesh.ply.certificate.json"}, folder_.path()).exit_code, 0);
    return triangles_in("mesh.ply.certificate.json");
  };
  const std::size_t reference = kill_and_count(
      [](test::EmaxProcess& process) { process.await_output("certified and written"); });
  const auto better_is_there = [&](test::EmaxProcess&) {
    for (int i = 0; i < 60'000 && triangles_in("mesh.ply.certificate.json") >= reference; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  const std::size_t better = kill_and_count(better_is_there);
  EXPECT_LT(better, reference);
  // What is there already is no worse for being continued.
  EXPECT_LE(kill_and_count([](test::EmaxProcess& process) { process.await_output("reference "); }),
            better);
}

TEST_F(Resume, ATornFirstRecordIsSaid) {
  const auto endless = command({"--resume", "night"}, "mesh.ply", "100000");
  test::EmaxProcess process(endless, folder_.path());
  await("night/evaluations.log", 1000);
  process.signal(SIGKILL);
  process.wait();
  std::filesystem::resize_file(folder_ / "night/evaluations.log", 20);
  const ProgramRun again = optimize({"--resume", "night", "--target-triangles", "100000"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(first_line(again),
            "run            starts in night; 12 bytes of a torn record were cut off");
}

TEST_F(Resume, MoreJobsThanCandidatesThatMayBeOutDoNotStart) {
  folder_.write("narrow.toml", "[search]\nlook_ahead = 2\n");
  const ProgramRun run =
      optimize({"--config", "narrow.toml", "--jobs", "9", "--target-triangles", "100000"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find(", 2 jobs, "), std::string::npos) << run.output;
}

// As with a disk that is full at the end: the place of the mesh is gone when it is to be written.
TEST_F(Resume, AMeshThatCannotBeWrittenIsNotLost) {
  std::filesystem::create_directory(folder_ / "out");
  const auto arguments = command({"--resume", "night"}, "out/mesh.ply", "40");
  test::EmaxProcess process(arguments, folder_.path());
  await("night/evaluations.log", 1000);
  std::filesystem::remove_all(folder_ / "out");
  const ProgramRun lost = process.wait();
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_NE(lost.errors.find("out/mesh.ply"), std::string::npos) << lost.errors;
  EXPECT_NE(lost.errors.find("cannot be written"), std::string::npos) << lost.errors;
  EXPECT_NE(lost.errors.find("the same command continues in night"), std::string::npos)
      << lost.errors;
  std::filesystem::create_directory(folder_ / "out");
  const ProgramRun again = test::run_emax(arguments, folder_.path());
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_NE(first_line(again).find("40 of 40"), std::string::npos) << again.output;
  ASSERT_EQ(test::run_emax(command({}, "mesh.ply", "40"), folder_.path()).exit_code, 0);
  EXPECT_EQ(test::bytes_of(folder_ / "out" / "mesh.ply"), test::bytes_of(folder_ / "mesh.ply"));
}

TEST_F(Resume, EffortChoosesTheBudget) {
  const auto evaluations = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"optimize", "scan.xyz", "--max-error", "5%",
                                          "-o",       "mesh.ply", "--json",      "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = test::run_emax(arguments, folder_.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(run.output.find("polished") == std::string::npos, more[1] == "quick") << run.output;
    return nlohmann::json::parse(test::bytes_of(folder_ / "r.json")).at("evaluations").get<int>();
  };
  EXPECT_EQ(evaluations({"--effort", "quick"}), 1);
  EXPECT_EQ(evaluations({"--effort", "deep", "--budget", "2"}), 2);
  folder_.write("few.toml", "[search]\nbudget = 3\n");
  EXPECT_EQ(evaluations({"--effort", "normal", "--config", "few.toml"}), 3);
}

TEST_F(Resume, StopsAndLimitsAreSaid) {
  const auto result = [this] { return nlohmann::json::parse(test::bytes_of(folder_ / "r.json")); };
  const ProgramRun target = optimize({"--target-triangles", "100000", "--json", "r.json"});
  ASSERT_EQ(target.exit_code, 0) << target.errors;
  EXPECT_NE(target.output.find("target reached"), std::string::npos) << target.output;
  EXPECT_EQ(result().at("ended_by"), "target");
  EXPECT_EQ(result().at("evaluations"), 1);

  ASSERT_EQ(optimize({"--stagnation", "1", "--json", "r.json"}).exit_code, 0);
  EXPECT_EQ(result().at("ended_by"), "stagnation");
  EXPECT_LT(result().at("evaluations"), 20);

  // No evaluation is done in a millisecond; each is counted.
  const ProgramRun hasty = test::run_emax(
      command({"--decimator", "schroeder", "--evaluation-time", "0.001"}, "mesh.ply", "3"),
      folder_.path());
  EXPECT_EQ(hasty.exit_code, 1);
  EXPECT_NE(hasty.errors.find("3 failed (timed out)"), std::string::npos) << hasty.errors;
  EXPECT_FALSE(exists("mesh.ply.run"));
  const ProgramRun small = optimize({"--evaluation-memory", "1 MB"});
  EXPECT_EQ(small.exit_code, 1);
  EXPECT_NE(small.errors.find("raise the memory limit"), std::string::npos) << small.errors;
  EXPECT_FALSE(exists("mesh.ply.run"));
}

}  // namespace
}  // namespace emax
