// `emax error` of a scan that comes through a pipe and can be read only once.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "tests/host/app/program.h"
#include "tests/support/las_of_points.h"
#include "tests/support/pipe_writer.h"
#include "tests/support/scan_bytes.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using test::ProgramRun;

using Words = std::vector<std::string>;

// Without the line that tells the time and without the name of the cloud.
std::string without_name(const std::string& text, const std::string& cloud) {
  std::string kept;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    for (const char* before : {"cloud          ", "mesh to cloud ", "\"reference\": \""}) {
      const std::size_t at = line.find(before + cloud);
      if (at != std::string::npos) line.erase(at + std::strlen(before), cloud.size());
    }
    if (!line.starts_with("device ")) kept += line + '\n';
  }
  return kept;
}

class ErrorStream : public testing::Test {
 protected:
  ErrorStream() : las_(test::las_of_points(test::bumpy_sphere(4, 4, 40000, 2).cloud)) {
    test::write_surface(folder_ / "surface.off", 10, 14);
    test::write_surface(folder_ / "fine.off", 40, 60);
  }

  ProgramRun error(const std::string& cloud, const Words& more) {
    Words words = {"error", cloud, "surface.off", "--json", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_emax(words, folder_.path());
  }
  ProgramRun error_of_fifo(const std::string& bytes, const Words& more) {
    const test::PipeWriter writer(folder_ / "pipe", bytes);
    return error("pipe", more);
  }
  ProgramRun error_of_input(const std::string& bytes, const Words& more, const char* name = "-") {
    const test::PipeWriter writer(folder_ / "pipe", bytes);
    const test::InputFrom input(folder_ / "pipe");
    return error(name, more);
  }

  // Whatever way the bytes come, the output and the JSON are those of the file.
  void expect_same(const Words& more, const std::string& bytes, const char* file = "scan.las") {
    SCOPED_TRACE(fmt::format("{}", fmt::join(more, " ")));
    folder_.write(file, bytes);
    const ProgramRun stored = error(file, more);
    ASSERT_NE(stored.exit_code, 1) << stored.errors;
    const std::string stored_json = without_name(test::file_text(folder_ / "r.json"), file);
    const auto expect = [&](const ProgramRun& run, const std::string& cloud) {
      EXPECT_EQ(run.exit_code, stored.exit_code) << run.errors;
      EXPECT_EQ(without_name(run.output, cloud), without_name(stored.output, file));
      EXPECT_EQ(without_name(test::file_text(folder_ / "r.json"), cloud), stored_json);
    };
    if (takes_fifo_) expect(error_of_fifo(bytes, more), "pipe");
    expect(error_of_input(bytes, more), "-");
    expect(error_of_input(bytes, more, "/dev/stdin"), "-");
  }

  void expect_refused(const std::string& bytes, const Words& more, const char* text,
                      const char* remedy) {
    SCOPED_TRACE(text);
    const ProgramRun run = error_of_fifo(bytes, more);
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    EXPECT_NE(run.errors.find("pipe: "), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find(text), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find(remedy), std::string::npos) << run.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r.json"));
  }

  test::TemporaryFolder folder_;
  const std::string las_;
  bool takes_fifo_ = true;
  const Words once_ = {"--memory", "0"};  // too little to keep the points
  const char* const store_ = "; store the scan in a file first";
};

TEST_F(ErrorStream, GivesTheResultOfTheFile) {
  for (const char* memory : {"0", "1GB"}) {
    expect_same({"--memory", memory}, las_);
    expect_same({"--memory", memory, "--max-error", "2%", "--worst", "7", "--quantile", "33"},
                las_);
    expect_same({"--memory", memory, "--two-sided", "--reference", "fine.off"}, las_);
    expect_same({"--memory", memory, "--unit", "mm"}, las_);
  }
}

TEST_F(ErrorStream, KeepsPointsThatFitIntoMemory) {
  const Words enough = {"--memory", "1GB"};
  const auto with = [&](Words more) {
    more.insert(more.end(), enough.begin(), enough.end());
    return more;
  };
  expect_same(with({"--exclude-outliers", "1%", "--max-error", "1%"}), las_);
  expect_same(with({"--class", "3,4"}), las_);
  expect_same(with({"--two-sided"}), las_);
  std::string other_box = las_;
  test::put(other_box, 179, 7.0);
  expect_same(enough, other_box);
}

TEST_F(ErrorStream, CopiesStandardInputThatIsNeededAgain) {
  takes_fifo_ = false;
  expect_same({"--memory", "0", "--exclude-outliers", "1%", "--max-error", "1%"}, las_);
  expect_same({"--memory", "0", "--class", "3,4"}, las_);
  test::write_scan(folder_ / "scan.xyz", 20000, 2);
  expect_same(once_, test::file_text(folder_ / "scan.xyz"), "scan.xyz");
}

TEST_F(ErrorStream, RefusesAHeaderThatLiesOfTheNumber) {
  std::string fewer = las_, more = las_;
  test::put(fewer, 107, std::uint32_t{39999});
  test::put(more, 107, std::uint32_t{40001});
  expect_refused(fewer, once_, "the header promises 39999 points, but more follow", "; ");
  expect_refused(more, once_, "the stream ends after 800227 bytes, before its data", "; see why");
  test::put(more, 107, std::uint32_t{4000000000});
  expect_refused(more, once_, "the stream ends after 800227 bytes, before its data", "; see why");
}

TEST_F(ErrorStream, RefusesAHeaderThatLiesOfTheBox) {
  const char* const other = "the box of its points is not the one that its header promises";
  for (std::size_t bound = 0; bound < 6; ++bound) {
    SCOPED_TRACE(bound);
    double value = 0;
    std::memcpy(&value, las_.data() + 179 + 8 * bound, sizeof value);
    for (const double moved : {value - 1e-9, value + 1e-9}) {
      std::string bytes = las_;
      test::put(bytes, 179 + 8 * bound, moved);
      expect_refused(bytes, once_, other, store_);
    }
  }
  std::string none = las_;
  std::fill_n(none.begin() + 179, 48, '\0');
  expect_refused(none, once_, "the header promises no box of its points", store_);
}

TEST_F(ErrorStream, RefusesAStreamThatIsCutOff) {
  expect_refused("", once_, "the stream is empty", store_);
  expect_refused(las_.substr(0, 200), once_, "200 bytes are fewer than a LAS header has", "; ");
  expect_refused(las_.substr(0, 300), once_, "the header promises 40000 points", "; ");
  for (const std::size_t size : {std::size_t{4096}, std::size_t{400000}, las_.size() - 1}) {
    expect_refused(las_.substr(0, size), once_,
                   fmt::format("the stream ends after {} bytes, before its data", size).c_str(),
                   "; see why");
    expect_refused(las_.substr(0, size), {},
                   fmt::format("the stream ends after {} bytes, before its data", size).c_str(),
                   "; see why");
  }
}

TEST_F(ErrorStream, NamesWhatNeedsMoreThanOneLook) {
  const auto with = [&](Words more) {
    more.insert(more.end(), once_.begin(), once_.end());
    return more;
  };
  expect_refused(las_, with({"--exclude-outliers", "1%"}),
                 "--exclude-outliers needs to see it twice", store_);
  expect_refused(las_, with({"--class", "3"}), "--class needs to see it twice", store_);
  expect_refused(las_, with({"--two-sided"}), "--two-sided without --reference needs all", "; ");
  expect_refused(las_, {"--report", "r.html"}, "--report states the checksum of a file", store_);
  std::string withheld = las_;
  withheld[227 + 20 * 1000 + 15] = static_cast<char>(0x80);
  expect_refused(withheld, once_, "some are left out (1 withheld)", store_);
}

TEST_F(ErrorStream, RefusesOtherFormats) {
  for (const char* bytes : {"0 0 0\n1 0 0\n", "ply\nformat ascii 1.0\n"}) {
    expect_refused(bytes, once_, "is a pipe, and only LAS without compression is read from one",
                   store_);
  }
  std::string compressed = las_;
  compressed[104] = static_cast<char>(0x80);
  expect_refused(compressed, once_, "only LAS without compression", "standard input as -");
}

}  // namespace
}  // namespace emax
