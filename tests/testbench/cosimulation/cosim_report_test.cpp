// What the co-simulation says: coverage counted from Verilator's files, mismatches in table and
// sum.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sw_model/base/error.h"
#include "testbench/cosimulation/coverage_report.h"
#include "testbench/cosimulation/suite.h"

namespace emax {
namespace {

namespace fs = std::filesystem;

class CoverageFiles : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("emax_coverage_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // A point as Verilator writes it.
  static std::string point(const std::string& kind, const std::string& module, int line,
                           const std::string& object, int hits) {
    return "C '\1f\2hls/rtl/" + module + ".sv\1l\2" + std::to_string(line) + "\1n\0023\1t\2" +
           kind + "\1page\2v_" + kind + "/" + module + "__W8\1o\2" + object + "\1h\2top' " +
           std::to_string(hits) + "\n";
  }
  std::string file(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name) << "# SystemC::Coverage-3\n" << content;
    return (folder_ / name).string();
  }

  fs::path folder_;
};

TEST_F(CoverageFiles, AreAddedPointByPoint) {
  const std::string one = file("one.dat", point("toggle", "fp_add", 7, "carry[0]", 0) +
                                              point("toggle", "fp_add", 7, "carry[1]", 4) +
                                              point("line", "fp_add", 9, "block", 0));
  const std::string two = file("two.dat", point("toggle", "fp_add", 7, "carry[0]", 0) +
                                              point("line", "fp_add", 9, "block", 1));
  const CoverageReport report = read_coverage({one, two});
  EXPECT_EQ(report.all[0].points, 1u);
  EXPECT_EQ(report.all[0].covered, 1u);
  EXPECT_EQ(report.all[2].points, 2u);
  EXPECT_EQ(report.all[2].covered, 1u);
  ASSERT_EQ(report.missed.size(), 1u);
  EXPECT_EQ(report.missed[0], "fp_add fp_add.sv:7 toggle carry[0]");
  EXPECT_DOUBLE_EQ(percent(report.all[2]), 50);
  EXPECT_NEAR(percent_of_all(report), 200.0 / 3, 1e-9);
}

TEST_F(CoverageFiles, ExceptOnlyWhatIsNamed) {
  const CoverageReport report =
      read_coverage({file("one.dat", point("toggle", "delay_line", 3, "words[0]", 0) +
                                         point("toggle", "delay_line", 4, "q[0]", 0))});
  EXPECT_EQ(report.all[2].points, 1u);
  ASSERT_EQ(report.excepted.size(), 1u);
  EXPECT_EQ(report.excepted.begin()->second, 1u);
}

TEST_F(CoverageFiles, WithoutPointsAreAnError) {
  EXPECT_THROW(read_coverage({file("none.dat", "")}), Error);
  EXPECT_THROW(read_coverage({(folder_ / "missing.dat").string()}), Error);
}

TEST_F(CoverageFiles, KeepTheShareOfEachTest) {
  const std::string path = (folder_ / "tests.txt").string();
  const std::map<std::string, double> shares = {{"pairs: slivers", 87.5}, {"streams: any", 12}};
  write_test_coverage(shares, path);
  EXPECT_EQ(read_test_coverage(path), shares);
  std::ofstream(path) << "no tab\n";
  EXPECT_THROW(read_test_coverage(path), Error);
  EXPECT_THROW(write_test_coverage(shares, (folder_ / "no" / "folder").string()), Error);
}

// An operator unit that is right but for one word.
class WrongOnce : public OperatorUnit {
 public:
  void run(std::span<const OperandPair> pairs, std::span<OperatorResults> results) override {
    host_results(pairs, results);
    if (cycles_ == 0) results[1].word[0] ^= 1u;
    cycles_ += pairs.size();
  }
  std::uint64_t cycles() const override { return cycles_; }
  void write_coverage(const std::string&) override {}

 private:
  std::uint64_t cycles_ = 0;
};

TEST(Suite, CountsTheMismatchOfAnOperator) {
  Suite suite;
  suite.filter = "operators";
  suite.operators = {binary32_test([] { return std::make_unique<WrongOnce>(); }, 1000)};
  std::uint64_t reported = 0;
  suite.finish = [&](TestReport& report) { reported += report.mismatches; };
  const SuiteResult result = run_suite(suite);
  EXPECT_EQ(result.mismatches, 1u);
  EXPECT_EQ(reported, 1u);
  EXPECT_GT(result.pairs, 1000u);
}

TEST(Suite, StopsWhenAsked) {
  const std::atomic<bool> stop = true;
  Suite suite;
  suite.filter = "operators";
  suite.options.stop = &stop;
  suite.operators = {binary32_test([] { return std::make_unique<WrongOnce>(); }, 1'000'000)};
  const SuiteResult result = run_suite(suite);
  EXPECT_TRUE(result.interrupted);
  EXPECT_LT(result.pairs, 100'000u);
}

TEST(Suite, AFilterThatFitsNothingIsAnError) {
  Suite suite;
  suite.filter = "no such test";
  EXPECT_THROW(run_suite(suite), Error);
}

}  // namespace
}  // namespace emax
