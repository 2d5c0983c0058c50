#include "host/device/device_evaluator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "evaluator_of.h"
#include "hls/kernel/command_words.h"
#include "host/block_search/block_search.h"
#include "host/device/device_address.h"
#include "host/engine/error_engine.h"
#include "sw_model/base/error.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/protocol/cpp_device.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using Engine = EmaxResult (*)(const PreparedCloud&, const TriangleTree&);

EmaxResult model(const PreparedCloud& cloud, const TriangleTree& mesh) {
  return emax_model(cloud.points(), mesh.records());
}
template <auto search>
EmaxResult on(const char* address, const PreparedCloud& cloud, const TriangleTree& mesh) {
  return search(cloud, mesh, *test::evaluator_of(address), SearchOptions{});
}

const std::vector<std::pair<const char*, Engine>> kEngines = {
    {"model", model},
    {"cpu searched", [](const auto& c, const auto& m) { return on<search_emax>("cpu", c, m); }},
    {"cpu brute force",
     [](const auto& c, const auto& m) { return on<brute_force_emax>("cpu", c, m); }},
    {"sim searched", [](const auto& c, const auto& m) { return on<search_emax>("sim", c, m); }},
    {"rtl searched", [](const auto& c, const auto& m) { return on<search_emax>("rtl", c, m); }},
    {"sim brute force",
     [](const auto& c, const auto& m) { return on<brute_force_emax>("sim", c, m); }},
    {"sim filtered",
     [](const auto& c, const auto& m) { return on<search_emax>("sim:filter", c, m); }},
    {"sim filtered, all pairs",
     [](const auto& c, const auto& m) { return on<brute_force_emax>("sim:filter", c, m); }},
    {"rtl filtered",
     [](const auto& c, const auto& m) { return on<search_emax>("rtl:filter", c, m); }},
    {"sim board",
     [](const auto& c, const auto& m) { return on<search_emax>("sim:board=ulx3s", c, m); }},
    {"sim board, all pairs",
     [](const auto& c, const auto& m) { return on<brute_force_emax>("sim:board=ulx3s", c, m); }},
    {"rtl board", [](const auto& c, const auto& m) { return on<search_emax>("rtl:board", c, m); }},
    {"opencl searched",
     [](const auto& c, const auto& m) { return on<search_emax>("opencl", c, m); }},
    {"opencl brute force",
     [](const auto& c, const auto& m) { return on<brute_force_emax>("opencl", c, m); }},
};

// Every engine against every other, the matrix printed.
TEST(Engines, AgreePairwiseBitForBit) {
  std::vector<std::vector<int>> differing(kEngines.size(), std::vector<int>(kEngines.size(), 0));
  int inputs = 0;
  for (std::uint64_t seed = 70; seed < 73; ++seed) {
    for (const test::Stimulus& s : test::all_stimuli(seed)) {
      const PreparedCloud cloud(s.cloud);
      const TriangleTree mesh(s.mesh(), cloud.normalization());
      std::vector<EmaxResult> results;
      for (const auto& [name, engine] : kEngines) results.push_back(engine(cloud, mesh));
      EXPECT_EQ(ErrorEngine(cloud).e_max(PreparedMesh(s.mesh(), cloud.normalization())),
                results[0]);
      for (std::size_t i = 0; i < results.size(); ++i) {
        for (std::size_t j = 0; j < results.size(); ++j) {
          differing[i][j] += !(results[i] == results[j]);
        }
        EXPECT_EQ(results[i], results[0])
            << kEngines[i].first << " on " << s.name << ", seed " << seed << ": "
            << describe_bits(results[i].squared_bits) << " at " << results[i].worst_point;
      }
      ++inputs;
    }
  }
  std::printf("inputs that differ, of %d:\n", inputs);
  for (std::size_t i = 0; i < kEngines.size(); ++i) {
    std::printf("  %-24s", kEngines[i].first);
    for (const int count : differing[i]) std::printf(" %4d", count);
    std::printf("\n");
  }
}

TEST(DeviceEvaluator, ListsThePointsOfABlock) {
  const test::Stimulus s = test::bumpy_sphere(12, 16, 2500, 74);
  const PreparedCloud cloud(s.cloud);
  const TriangleTree mesh(s.mesh(), cloud.normalization());
  const auto sim = test::evaluator_of("sim");
  EXPECT_EQ(search_nearest(cloud, mesh, *sim),
            nearest_squared_bits(cloud.points(), mesh.records()));
}

TEST(DeviceEvaluator, CountsWhatItSends) {
  const test::Stimulus s = test::bumpy_sphere(12, 16, 2500, 75);
  const PreparedCloud cloud(s.cloud);
  const TriangleTree mesh(s.mesh(), cloud.normalization());
  const auto sim = test::evaluator_of("sim:board=u50");
  brute_force_emax(cloud, mesh, *sim);
  const DeviceCounters counters = sim->counters();
  const std::uint64_t triangles = s.triangles.size();
  EXPECT_EQ(counters.blocks, 3u);  // 2500 points in blocks of 1024
  EXPECT_EQ(counters.pairs, 2500 * triangles);
  EXPECT_EQ(counters.words_in, 3 * (3 + 20 * triangles) + 3 * 2500);
  EXPECT_EQ(counters.words_out, 9u);
  EXPECT_GT(counters.cycles.value(), 0u);
  EXPECT_EQ(counters.resends, std::nullopt);
}

// Counts three cycles, until it is gone; or it lost them when it began again.
class Counting : public Device {
 public:
  std::string name() const override { return "counting"; }
  void send(std::span<const Word> words) override {
    if (words[0] != command_header(kCounters, 0)) return device_->send(words);
    if (gone) throw Error("unplugged");
    answer_ = {command_header(kCounters, kAnswerCounters), 3, 0, 0, 0, 0, 0};
  }
  void receive(std::span<Word> words) override {
    if (answer_.empty()) return device_->receive(words);
    std::copy_n(answer_.begin(), words.size(), words.begin());
    answer_.erase(answer_.begin(), answer_.begin() + static_cast<std::ptrdiff_t>(words.size()));
  }
  DeviceCounters counters() const override {
    DeviceCounters counters;
    counters.began_again = began_again;
    return counters;
  }

  bool gone = false, began_again = false;

 private:
  std::unique_ptr<Device> device_ = std::make_unique<CppDevice>();
  std::vector<Word> answer_;
};

TEST(DeviceEvaluator, GivesWhatItKnowsOfADeviceThatIsGoneOrBeganAgain) {
  const test::Stimulus s = test::bumpy_sphere(12, 16, 100, 77);
  const PreparedCloud cloud(s.cloud);
  const TriangleTree mesh(s.mesh(), cloud.normalization());
  auto made = std::make_unique<Counting>();
  Counting& device = *made;
  DeviceEvaluator evaluator(std::move(made));
  brute_force_emax(cloud, mesh, evaluator);
  EXPECT_EQ(evaluator.counters().cycles, 3u);
  device.began_again = true;
  EXPECT_EQ(evaluator.counters().cycles, std::nullopt);
  EXPECT_EQ(evaluator.counters().busy, std::nullopt);
  device.began_again = false;
  device.gone = true;
  EXPECT_EQ(evaluator.counters().cycles, std::nullopt);
  EXPECT_EQ(evaluator.counters().blocks, 1u);
}

TEST(DeviceEvaluator, StartsAfreshAfterAnInterruptedSearch) {
  const test::Stimulus s = test::bumpy_sphere(12, 16, 20000, 76);
  const PreparedCloud cloud(s.cloud);
  const TriangleTree mesh(s.mesh(), cloud.normalization());
  const auto sim = test::evaluator_of("sim");
  int asked = 0;
  SearchOptions options;
  options.interrupted = [&asked] { return ++asked > 2; };
  EXPECT_THROW(search_emax(cloud, mesh, *sim, options), Interrupted);
  EXPECT_EQ(search_emax(cloud, mesh, *sim), on<search_emax>("cpu", cloud, mesh));
}

TEST(DeviceAddress, NamesWhatItAccepts) {
  EXPECT_EQ(DeviceAddress::parse("sim:board=ulx3s").board->name, "ulx3s");
  EXPECT_EQ(DeviceAddress::parse("xrt:a:b.xclbin@1").place, "a:b.xclbin@1");
  EXPECT_EQ(DeviceAddress::parse("rtl:pes=2").elements, 2u);
  EXPECT_EQ(DeviceAddress::parse("rtl").filter_elements, 0u);
  EXPECT_EQ(DeviceAddress::parse("rtl:filter").filter_elements, 4u);
  EXPECT_EQ(DeviceAddress::parse("sim:filter").filter_elements, 4u);
  EXPECT_TRUE(DeviceAddress::parse("rtl:board").is_board);
  EXPECT_TRUE(DeviceAddress::parse("sim:board=ulx3s").is_board);
  EXPECT_FALSE(DeviceAddress::parse("sim:board=u50").is_board);
  EXPECT_EQ(DeviceAddress::parse("opencl").number, 0u);
  EXPECT_EQ(DeviceAddress::parse("opencl:12").number, 12u);
  EXPECT_EQ(DeviceAddress::parse("tty:/dev/ttyUSB0").place, "/dev/ttyUSB0");
  EXPECT_EQ(DeviceAddress::parse("tty:/dev/ttyUSB0").baud, 3000000u);
  EXPECT_EQ(DeviceAddress::parse("tty:/dev/a:b@115200").place, "/dev/a:b");
  EXPECT_EQ(DeviceAddress::parse("tty:/dev/a:b@115200").baud, 115200u);
  for (const char* bad : {"gpu",           "sim:",
                          "sim:board=",    "sim:board=x",
                          "cpu:1",         "",
                          "rtl:",          "rtl:pes=3",
                          "rtl:filters",   "sim:filter=",
                          "opencl:filter", "rtl:pes=2x",
                          "opencl:",       "opencl:x",
                          "opencl:-1",     "tty",
                          "tty:",          "tty:@9600",
                          "tty:/dev/x@",   "tty:/dev/x@fast",
                          "tty:/dev/x@1",  "xrt:"}) {
    try {
      DeviceAddress::parse(bad);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      // An unknown form names every form; a wrong part names what that part may be.
      EXPECT_NE(std::string(error.what()).find_first_of(";"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace emax
