#include "testbench/diagnosis/save_file.h"

#include <gtest/gtest.h>
#include <gtkwave/fstapi.h>

#include <filesystem>
#include <fstream>

#include "sw_model/base/error.h"

namespace emax {
namespace {

namespace fs = std::filesystem;

// A waveform with the signals top.clk and top.inner.x[31:0].
class SaveFile : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = (fs::temp_directory_path() / (std::string("emax_save_file_") + info->name() + ".fst"))
                .string();
    void* writer = fstWriterCreate(path_.c_str(), 1);
    ASSERT_NE(writer, nullptr);
    fstWriterSetScope(writer, FST_ST_VCD_MODULE, "top", nullptr);
    const fstHandle clock =
        fstWriterCreateVar(writer, FST_VT_VCD_WIRE, FST_VD_IMPLICIT, 1, "clk", 0);
    fstWriterSetScope(writer, FST_ST_VCD_MODULE, "inner", nullptr);
    fstWriterCreateVar(writer, FST_VT_VCD_WIRE, FST_VD_IMPLICIT, 32, "x [31:0]", 0);
    fstWriterSetUpscope(writer);
    fstWriterSetUpscope(writer);
    for (const std::uint64_t time : {0u, 1u}) {
      fstWriterEmitTimeChange(writer, time);
      fstWriterEmitValueChange(writer, clock, time == 0 ? "0" : "1");
    }
    fstWriterClose(writer);
  }
  void TearDown() override { fs::remove(path_); }

  std::string path_;
};

TEST_F(SaveFile, ReadsTheSignalsOfAWaveform) {
  const std::map<std::string, std::string> expected = {{"top.clk", "top.clk"},
                                                       {"top.inner.x", "top.inner.x[31:0]"}};
  EXPECT_EQ(signals_of(path_), expected);
}

TEST_F(SaveFile, ListsSignalsBelowTheirHeading) {
  const std::string text = save_file({{"a clock", {"top.clk"}}, {"x", {"top.inner.x"}}}, path_, 90);
  EXPECT_NE(
      text.find("\n[dumpfile] \"" + path_ + "\"\n[savefile] \"" +
                path_.substr(0, path_.size() - 4) + ".gtkw\"\n[timestart] 30\n*-3.000000 90 -1"),
      std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("\n@200\n-a clock\n@28\ntop.clk\n@200\n-x\n@22\ntop.inner.x[31:0]\n"))
      << text;
}

TEST_F(SaveFile, RefusesASignalThatTheWaveformLacks) {
  try {
    save_file({{"x", {"top.x"}}}, path_, 0);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), path_ + " has no signal top.x");
  }
  std::ofstream(path_) << "no waveform";
  EXPECT_THROW(signals_of(path_), Error);
  EXPECT_THROW(signals_of(path_ + ".none"), Error);
}

TEST_F(SaveFile, NamesAnOperandAsItIsReadyAndAsItIsRead) {
  NodeMismatch mismatch{};
  mismatch.name = "d";
  mismatch.operands = {{0, "a", "a_at_3", ValueKind::kReal, 0, Word{1}},
                       {1, "a", "a", ValueKind::kReal, 0, Word{1}},
                       {2, "ONE", "ONE", ValueKind::kReal, 0, std::nullopt}};
  const auto groups = signal_groups(mismatch);
  ASSERT_EQ(groups.size(), 4u);
  const std::string datapath = "TOP.emax_element.distance.datapath.";
  EXPECT_EQ(groups[2].signals, std::vector{datapath + "d"});
  EXPECT_EQ(groups[3].signals, (std::vector{datapath + "a", datapath + "a_at_3"}));
  EXPECT_EQ(signal_groups({}).size(), 3u);
}

}  // namespace
}  // namespace emax
