// The Verilated filtering core beside its twin in C++, bit for bit.
#include <gtest/gtest.h>

#include <set>

#include "sw_model/base/error.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/cycle_model.h"
#include "testbench/core/core_driver.h"
#include "testbench/core/filter_stimuli.h"
#include "testbench/core/rtl_device.h"
#include "testbench/operators/mutant_list.h"

namespace emax::test {
namespace {

class FilterCore : public testing::TestWithParam<std::uint32_t> {
 protected:
  void expect_answers(const std::vector<Word>& words, const CorePatterns& patterns = {}) {
    auto expected = answers_of_filter(words);
    name_elements(expected, core_->elements());
    ASSERT_EQ(run_core(*core_, words, patterns), expected);
    answered_ += expected.size();
  }

  std::unique_ptr<CoreSimulation> core_ = make_filter(GetParam());
  std::size_t answered_ = 0;
};

TEST_P(FilterCore, AnswersAnyCommandsAsTheTop) {
  const std::vector<FilterMaterial> all = {filter_material(5), filter_edges(5)};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    expect_answers(any_filter_commands(all, 150, random));
  }
  EXPECT_GT(answered_, 5000u);
}

TEST_P(FilterCore, IdleCyclesAndBackPressureChangeNoWord) {
  const std::vector<FilterMaterial> all = {filter_material(6), filter_edges(6)};
  for (std::uint32_t in = 0; in < kPatterns; ++in) {
    for (std::uint32_t out = 0; out < kPatterns; ++out) {
      const CorePatterns patterns = {static_cast<Pattern>(in), static_cast<Pattern>(out),
                                     in * kPatterns + out};
      SCOPED_TRACE(std::string(name_of(patterns.commands)) + ", " +
                   std::string(name_of(patterns.answers)));
      Random random(patterns.seed);
      auto words = any_filter_commands(all, 12, random);
      const auto block = filter_block(all[in % 2], 300 + random.below(40), 3, true, random);
      words.insert(words.end(), block.begin(), block.end());
      expect_answers(words, patterns);
    }
  }
}

TEST_P(FilterCore, EveryBlockSizeAroundTheNumberOfElements) {
  const FilterMaterial m = filter_material(7);
  Random random(7);
  std::vector<Word> words;
  for (std::size_t points = 1; points <= 24; ++points) {
    for (std::size_t records = 0; records <= 3; ++records) {
      const auto block = filter_block(m, points, records, points % 2 == 0, random);
      words.insert(words.end(), block.begin(), block.end());
    }
  }
  expect_answers(words);
}

TEST_P(FilterCore, ResetInMidStreamLeavesNothingBehind) {
  const FilterMaterial m = filter_material(8);
  Random random(8);
  for (int i = 0; i < 40; ++i) {
    const auto broken =
        filter_block(m, 1 + random.below(200), 1 + random.below(20), random.one_in(2), random);
    const std::size_t cut = random.below(broken.size());
    for (std::size_t sent = 0; sent < cut;) {
      core_->offer_command(&broken[sent]);
      core_->set_answer_ready(false);
      sent += core_->outputs().command_ready ? 1 : 0;
      core_->clock();
    }
    core_->offer_command(nullptr);
    for (std::uint32_t wait = random.below(400); wait > 0; --wait) core_->clock();
    core_->clock(true);
    core_->clock(true);
    expect_answers(filter_block(m, 1 + random.below(40), random.below(5), true, random));
  }
}

// 1024 points in 1000 records: a row of pairs in nine cycles of ten or more.
TEST_P(FilterCore, ElementsAreBusyOnADenseBlock) {
  const FilterMaterial m = filter_material(6);
  Random random(10);
  const std::size_t records = 1000;
  const auto words = filter_block(m, kMaxBlockPoints, records, false, random);
  std::uint64_t cycles = 0;
  EXPECT_EQ(run_core(*core_, words, {}, &cycles), answers_of_filter(words));
  const double rows = static_cast<double>(records * kMaxBlockPoints) / core_->elements();
  std::printf("%u elements: %.3f pairs a cycle\n", core_->elements(),
              rows * core_->elements() / static_cast<double>(cycles));
  EXPECT_GE(rows / static_cast<double>(cycles), 0.90);
}

struct FilterWork {
  std::size_t points, records;
  bool list_points;
};

TEST_P(FilterCore, CyclesAreThoseOfTheModel) {
  Random random(3);
  std::vector<FilterWork> any;
  for (int i = 0; i < 40; ++i) {
    any.push_back({1 + random.below(1024), random.below(80), random.one_in(3)});
  }
  const std::vector<std::pair<std::string, std::vector<FilterWork>>> cases = {
      {"a dense block", {{1024, 300, false}}},
      {"full blocks", std::vector<FilterWork>(3, {1024, 60, false})},
      {"listed blocks", std::vector<FilterWork>(3, {1000, 20, true})},
      {"small blocks", std::vector<FilterWork>(40, {64, 40, true})},
      {"tiny blocks", std::vector<FilterWork>(60, {7, 30, false})},
      {"blocks without records", std::vector<FilterWork>(5, {512, 0, true})},
      {"any blocks, seed 3", any}};
  const FilterMaterial m = filter_material(9);
  for (const auto& [name, blocks] : cases) {
    CycleModel model(GetParam(), kFilterCore);
    std::vector<Word> words;
    for (const FilterWork& work : blocks) {
      const auto block = filter_block(m, work.points, work.records, work.list_points, random);
      words.insert(words.end(), block.begin(), block.end());
      model.load_points(work.points);
      model.stream_records(work.records);
      model.reduce(work.list_points);
    }
    std::uint64_t cycles = 0;
    run_core(*core_, words, {}, &cycles);
    const auto measured = static_cast<double>(cycles),
               predicted = static_cast<double>(model.cycles());
    std::printf("%u elements, %s: core %.0f, model %.0f cycles, %+.2f %%\n", GetParam(),
                name.c_str(), measured, predicted, 100 * (predicted / measured - 1));
    EXPECT_NEAR(predicted, measured, 0.005 * measured + 24) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, FilterCore,
                         testing::ValuesIn(rtl_filter_counts().begin(), rtl_filter_counts().end()),
                         testing::PrintToStringParamName());

TEST(FilterCores, AreToldFromExactOnes) {
  const auto filter = make_rtl_filter(1);
  require_filter(*filter);
  EXPECT_THROW(require_compatible(*filter), Error);
  const auto exact = make_rtl_device(1);
  EXPECT_THROW(require_filter(*exact), Error);
  EXPECT_THROW(make_rtl_filter(3), Error);
}

// Blocks that end, are given up, are reduced twice, are too large; few points and many; ties.
std::vector<Word> every_kind_of_filter_block() {
  const FilterMaterial m = filter_material(3), edges = filter_edges(3);
  Random random(3);
  std::vector<Word> words;
  for (const std::size_t count : {1, 2, 3, 7, 40, 200}) {
    for (const bool list_points : {false, true}) {
      for (const FilterMaterial* material : {&m, &edges}) {
        const auto block = filter_block(*material, count, 3, list_points, random);
        words.insert(words.end(), block.begin(), block.end());
      }
    }
    append_filter_reduce(words, false);
    append_filter_points(words, any_of(m.points, count, random));
    append_filter_records(words, any_of(m.records, 4, random));
  }
  append_filter_points(words, any_of(m.points, kMaxBlockPoints + 1, random));
  append_filter_reduce(words, false);
  // All points of one distance: the lowest index must win whichever element has it.
  append_filter_points(words, std::vector<FilterPoint>(9, m.points[0]));
  append_filter_records(words, any_of(m.records, 2, random));
  append_filter_reduce(words, false);
  // Element 0 has the later of two greatest.
  std::vector<FilterPoint> two(4, m.points[0]);
  two[1] = two[2] = edges.points[0];
  append_filter_points(words, two);
  append_filter_records(words, any_of(m.records, 1, random));
  append_filter_reduce(words, false);
  return words;
}

bool is_caught(std::uint32_t mutant, const std::vector<Word>& words) {
  const auto core = make_mutated_filter();
  core->set_mutant(mutant);
  core->clock(true);
  try {
    return run_core(*core, words) != answers_of_filter(words);
  } catch (const Error&) {
    return true;  // an assertion, or no end
  }
}

TEST(FilterCoreMutants, EachIsCaught) {
  const auto words = every_kind_of_filter_block();
  EXPECT_FALSE(is_caught(0, words));
  const std::set<std::string> shared = {"fixed/fixed_add", "fixed/fixed_fit", "fixed/fixed_less",
                                        "running_minimum"};
  std::size_t mutants = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    const bool own = mutant.module.starts_with("core/") || mutant.module.starts_with("filter/");
    if (!own && !shared.contains(mutant.module)) continue;
    // The filter's points start at all ones anyhow, and it compares numbers only with 0 and with
    // what is not negative.
    if (mutant.name == "FIRST_WITHOUT_INFINITY" || mutant.name == "FIXED_LESS_UNSIGNED") continue;
    ++mutants;
    EXPECT_TRUE(is_caught(static_cast<std::uint32_t>(mutant.number), words)) << mutant.name;
  }
  EXPECT_GE(mutants, 20u);
}

}  // namespace
}  // namespace emax::test
