#include "sw_model/protocol/cycle_model.h"

#include <gtest/gtest.h>

#include <string>

#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "testbench/core/core_driver.h"
#include "testbench/core/rtl_device.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

struct Work {
  std::size_t points, records;
  bool list_points;
};

// The cycles that the Verilated core takes for blocks sent one behind the other.
std::uint64_t core_cycles(CoreSimulation& core, const std::vector<Work>& blocks) {
  std::vector<Word> words;
  for (const Work& work : blocks) {
    append_load_points(words, std::vector<Vector3<float>>(work.points, {0.1f, 0.2f, 0.3f}));
    append_records(words, std::vector<TriangleRecord<float>>(work.records));
    append_reduce(words, work.list_points);
  }
  std::uint64_t cycles = 0;
  run_core(core, words, {}, &cycles);
  return cycles;
}

std::uint64_t model_cycles(std::uint32_t elements, const std::vector<Work>& blocks) {
  CycleModel model(elements);
  for (const Work& work : blocks) {
    model.load_points(work.points);
    model.stream_records(work.records);
    model.reduce(work.list_points);
  }
  return model.cycles();
}

class Cycles : public testing::TestWithParam<std::uint32_t> {
 protected:
  void expect_agreement(const std::string& name, const std::vector<Work>& blocks) {
    const auto measured = static_cast<double>(core_cycles(*core_, blocks));
    const auto predicted = static_cast<double>(model_cycles(GetParam(), blocks));
    std::printf("%u elements, %s: core %.0f, model %.0f cycles, %+.2f %%\n", GetParam(),
                name.c_str(), measured, predicted, 100 * (predicted / measured - 1));
    // The driver looks on for some cycles after the last word.
    EXPECT_NEAR(predicted, measured, 0.005 * measured + 24) << name;
  }

 private:
  std::unique_ptr<CoreSimulation> core_ = make_core(GetParam());
};

TEST_P(Cycles, OfTheModelAreThoseOfTheCore) {
  expect_agreement("a dense block", {{1024, 300, false}});
  expect_agreement("full blocks", std::vector<Work>(3, {1024, 60, false}));
  expect_agreement("listed blocks", std::vector<Work>(3, {1000, 20, true}));
  expect_agreement("small blocks", std::vector<Work>(40, {64, 40, false}));
  expect_agreement("tiny blocks", std::vector<Work>(60, {7, 30, false}));
  expect_agreement("blocks without records", std::vector<Work>(5, {512, 0, true}));
  Random random(3);
  std::vector<Work> any;
  for (int i = 0; i < 40; ++i) {
    any.push_back({1 + random.below(1024), random.below(80), random.one_in(3)});
  }
  expect_agreement("any blocks, seed 3", any);
}

INSTANTIATE_TEST_SUITE_P(Elements, Cycles,
                         testing::ValuesIn(rtl_element_counts().begin(),
                                           rtl_element_counts().end()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace emax
