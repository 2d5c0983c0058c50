// The machinery of a mismatch, on faults put into the design on purpose.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sw_model/base/error.h"
#include "testbench/cosimulation/failure_handling.h"
#include "testbench/element/verilated_variants.h"
#include "testbench/operators/mutant_list.h"

namespace emax {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::uint32_t mutant_named(const std::string& name) {
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (mutant.name == name) return static_cast<std::uint32_t>(mutant.number);
  }
  throw std::out_of_range(name);
}

Failure failure_of(const std::string& mutant, const std::string& test) {
  CosimulationOptions options;
  options.mutant = mutant_named(mutant);
  for (const ElementTest& t : element_tests()) {
    if (t.name != test) continue;
    const TestReport report = run_test(t, make_mutated_element, options);
    if (report.failure) return *report.failure;
  }
  throw std::out_of_range(mutant + " is not seen by " + test);
}

class Failures : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    parent_ = fs::temp_directory_path() / (std::string("emax_failures_") + info->name());
    fs::remove_all(parent_);
  }
  void TearDown() override { fs::remove_all(parent_); }

  fs::path parent_;
};

TEST_F(Failures, LeaveASmallFolderThatReplaysAndPassesUnchanged) {
  const Failure failure = failure_of("EDGES_SWAPPED", "pairs: bumpy sphere");
  const fs::path folder = keep_failure(failure, make_mutated_element, parent_, 300);
  const Failure kept = read_failure(folder);
  ASSERT_EQ(kept.runs.size(), 1u);
  EXPECT_EQ(kept.runs[0].pairs.size(), 1u);
  EXPECT_EQ(kept.runs[0].records.size(), 1u);
  EXPECT_EQ(kept.test, failure.test);
  EXPECT_EQ(kept.seed, failure.seed);
  EXPECT_EQ(kept.mutant, failure.mutant);

  const std::string report = content(folder / "report.txt");
  EXPECT_NE(report.find("first diverging node: a"), std::string::npos)
      << report;  // along or across
  // The path stands in the repository, not in the build folder.
  EXPECT_NE(report.find(", hls/kernel/point_triangle.h:"), std::string::npos) << report;
  EXPECT_NE(report.find("model   0x"), std::string::npos) << report;
  EXPECT_GT(fs::file_size(folder / "waveform.fst"), 1000u);

  // The edges of the record are swapped before they reach the datapath, which an operand shows.
  EXPECT_NE(report.find(" and record 0\n  x  0x"), std::string::npos) << report;
  EXPECT_NE(report.find("its operands, which it reads in cycle"), std::string::npos) << report;
  const std::size_t operand = report.find("  t_edge");
  ASSERT_NE(operand, std::string::npos) << report;
  EXPECT_NE(report.find(", differs\n    model   0x", operand), std::string::npos) << report;
  EXPECT_NE(report.find("the fault lies before it"), std::string::npos) << report;

  EXPECT_EQ(run_replay(folder, {}), 1);
  EXPECT_EQ(run_replay(folder, {"--mutant", "0"}), 0);
}

TEST_F(Failures, OfAnOperatorShowOperandsThatAgree) {
  const fs::path folder = keep_failure(failure_of("MULTIPLY_LOST_STICKY", "pairs: bumpy sphere"),
                                       make_mutated_element, parent_, 300);
  const std::string report = content(folder / "report.txt");
  EXPECT_NE(report.find("first diverging node: "), std::string::npos) << report;
  EXPECT_NE(report.find("The operands agree when they are ready"), std::string::npos) << report;
  EXPECT_EQ(report.find(", differs"), std::string::npos) << report;
}

// In GTKWave's format: a heading, then signals that the waveform has. A signal that it lacks is an
// error of emax_cosim_replay.
TEST_F(Failures, LeaveASaveFileWithTheNodeItsOperandsAndTheHandshakes) {
  const fs::path folder = keep_failure(failure_of("EDGES_SWAPPED", "pairs: bumpy sphere"),
                                       make_mutated_element, parent_, 300);
  const std::string report = content(folder / "report.txt");
  const std::string save = content(folder / "waveform.gtkw");
  const std::string datapath = "\n@22\nTOP.emax_element.distance.datapath.";
  const auto holds = [&](const std::string& text) {
    EXPECT_NE(save.find(text), std::string::npos) << text << " in\n" << save;
  };
  holds("[dumpfile] \"" + fs::absolute(folder / "waveform.fst").string() + "\"\n");
  holds("\n@200\n-clock and reset\n@28\nTOP.emax_element.clk\n@28\nTOP.emax_element.aresetn\n");
  holds("\n@28\nTOP.emax_element.s_axis_point_tvalid\n");
  holds("\n@28\nTOP.emax_element.s_axis_point_tready\n");
  const std::size_t node = report.find("first diverging node: ") + 22;
  holds("\n@200\n-failing node" + datapath + report.substr(node, report.find(' ', node) - node) +
        "[31:0]\n@200\n-its operands\n");
  const std::size_t operand = report.find("\n  t_edge") + 3;
  holds(datapath + report.substr(operand, report.find(',', operand) - operand) + "[31:0]\n");
  holds("_at_59[31:0]\n");
  holds("\n*-3.000000 ");

  const fs::path behind = keep_failure(failure_of("LAST_LOST", "blocks: of a few points"),
                                       make_mutated_element, parent_, 300);
  EXPECT_NE(content(behind / "waveform.gtkw").find("TOP.emax_element.minimum[31:0]"),
            std::string::npos);
}

TEST_F(Failures, ReplayFromAnyFolderWithTheBuildThatWroteThem) {
  const fs::path folder =
      keep_failure(failure_of("EDGES_SWAPPED", "pairs: bumpy sphere"), make_mutated_element,
                   parent_ / "a \"folder\" of $HOME", 300);
  // Also where the folder was moved to.
  const fs::path moved = parent_ / "moved";
  fs::rename(folder, moved);
  const auto status_of = [&](const std::string& command) {
    const int status = std::system(("cd / && sh '" + (moved / "replay.sh").string() + "' " +
                                    command + " >'" + (parent_ / "out").string() + "' 2>&1")
                                       .c_str());
    return WEXITSTATUS(status);
  };
  EXPECT_EQ(status_of(""), 1);
  EXPECT_NE(content(parent_ / "out").find("first diverging node: "), std::string::npos);
  EXPECT_EQ(status_of("--mutant 0"), 0);
  setenv("EMAX_COSIM_REPLAY", (parent_ / "none").c_str(), 1);
  EXPECT_EQ(status_of(""), 2);
  EXPECT_NE(content(parent_ / "out").find("none is not there"), std::string::npos);
  unsetenv("EMAX_COSIM_REPLAY");
}

TEST_F(Failures, BehindTheDatapathNameNoNode) {
  const fs::path folder = keep_failure(failure_of("LAST_LOST", "blocks: of a few points"),
                                       make_mutated_element, parent_, 300);
  const std::string report = content(folder / "report.txt");
  EXPECT_NE(report.find("every node of the graph agrees"), std::string::npos) << report;
  EXPECT_NE(report.find("what the reductions read for it, by the model:\n  squared distance"),
            std::string::npos)
      << report;
  EXPECT_NE(report.find("\n  least so far          0x7f800000"), std::string::npos) << report;
  EXPECT_EQ(run_replay(folder, {}), 1);
}

// The run does not go on to the words that such an element still gives, nor to their end.
TEST_F(Failures, EndAtTheFirstBrokenContract) {
  const Failure failure = failure_of("CREDIT_NOT_TAKEN", "blocks: of a few points");
  EXPECT_EQ(failure.mismatch.stream, "assertion");
  const auto element = make_mutated_element(kPairsSlotBits);
  element->set_mutant(failure.mutant);
  const RunResult result = run_sequence(failure.runs, *element);
  ASSERT_TRUE(result.mismatch);
  EXPECT_EQ(result.mismatch->cycle + 1, result.cycles);
  EXPECT_LT(result.worst, expected_of(failure.runs.back()).worst.size());
}

TEST_F(Failures, ShrinkToTheBeatsThatMatter) {
  const auto shrunk = [](const char* mutant, const char* test) {
    return shrink(failure_of(mutant, test), make_mutated_element);
  };
  // The minimum of two pairs, the second the nearer... and a third that reads it.
  const Failure minimum = shrunk("MINIMUM_NOT_KEPT", "blocks: of many points");
  EXPECT_LE(minimum.runs.back().pairs.size(), 12u);
  EXPECT_TRUE(minimum.runs.back().patterns.all_willing());
  const Failure stale = shrunk("WORST_NEVER_STARTS_ANEW", "blocks: of a few points");
  EXPECT_EQ(stale.runs.back().pairs.size(), 2u);
  // The run that the reset cut is part of it.
  const Failure reset = shrunk("VALID_OUTLIVES_RESET", "streams: reset in mid-stream");
  ASSERT_EQ(reset.runs.size(), 2u);
  EXPECT_TRUE(reset.runs[0].cut);
}

TEST_F(Failures, ThatCannotBeReadNameTheFile) {
  EXPECT_THROW(read_failure(parent_), Error);
  fs::create_directories(parent_);
  std::ofstream(parent_ / "input.txt") << "test x\nseed y\n";
  try {
    read_failure(parent_);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("input.txt"), std::string::npos);
  }
  EXPECT_EQ(run_replay(parent_, {}), 2);
}

}  // namespace
}  // namespace emax
