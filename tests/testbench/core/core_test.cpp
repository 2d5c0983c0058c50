#include <gtest/gtest.h>

#include <memory>

#include "sw_model/base/error.h"
#include "sw_model/protocol/commands.h"
#include "testbench/core/core_driver.h"
#include "testbench/core/core_stimuli.h"
#include "testbench/core/rtl_device.h"

namespace emax::test {
namespace {

struct CycleCount {
  std::uint64_t busy, stalled, idle;
};

CycleCount cycles_of(CoreSimulation& core) {
  const auto words = run_core(core, std::vector<Word>{command_header(kCounters, 0)});
  EXPECT_EQ(words.size(), 1 + kAnswerCounters);
  EXPECT_EQ(words.at(0), command_header(kCounters, kAnswerCounters));
  const auto pair = [&](std::size_t i) {
    return words.at(i) | (std::uint64_t(words.at(i + 1)) << 32);
  };
  return {pair(1), pair(3), pair(5)};
}

class Core : public testing::TestWithParam<std::uint32_t> {
 protected:
  std::unique_ptr<CoreSimulation> core_ = make_core(GetParam());
};

TEST_P(Core, AnswersAnyCommandsAsTheTop) {
  const auto all = materials(5);
  std::size_t answered = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    auto words = any_commands(all, 150, random);
    append_reduce(words, false);  // nothing stays open
    auto expected = answers_of_kernel(words);
    name_elements(expected, core_->elements());
    ASSERT_EQ(run_core(*core_, words), expected);
    answered += expected.size();
  }
  EXPECT_GT(answered, 2000u);
}

TEST_P(Core, IdleCyclesAndBackPressureChangeNoWord) {
  const auto all = materials(6);
  for (std::uint32_t in = 0; in < kPatterns; ++in) {
    for (std::uint32_t out = 0; out < kPatterns; ++out) {
      const CorePatterns patterns = {static_cast<Pattern>(in), static_cast<Pattern>(out),
                                     in * kPatterns + out};
      SCOPED_TRACE(std::string(name_of(patterns.commands)) + ", " +
                   std::string(name_of(patterns.answers)));
      Random random(patterns.seed);
      auto words = any_commands(all, 12, random);
      append_load_points(words, any_of(all[0].points, 300 + random.below(40), random));
      append_records(words, any_of(all[0].records, 3, random));
      append_reduce(words, true);
      auto expected = answers_of_kernel(words);
      name_elements(expected, core_->elements());
      ASSERT_EQ(run_core(*core_, words, patterns), expected);
    }
  }
}

TEST_P(Core, EveryBlockSizeAroundTheNumberOfElements) {
  const Material m = materials(7)[1];
  Random random(7);
  std::vector<Word> words;
  for (std::size_t points = 1; points <= 24; ++points) {
    for (std::size_t records = 0; records <= 3; ++records) {
      const auto block = dense_block(m, points, records, points % 2 == 0, random);
      words.insert(words.end(), block.begin(), block.end());
    }
  }
  EXPECT_EQ(run_core(*core_, words), answers_of_kernel(words));
}

TEST_P(Core, ResetInMidStreamLeavesNothingBehind) {
  const auto all = materials(8);
  Random random(8);
  for (int i = 0; i < 40; ++i) {
    const auto broken =
        dense_block(all[0], 1 + random.below(200), 1 + random.below(20), random.one_in(2), random);
    // Some of the words, some cycles, then the reset.
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
    const auto words = dense_block(all[1], 1 + random.below(40), random.below(5), true, random);
    ASSERT_EQ(run_core(*core_, words), answers_of_kernel(words)) << "round " << i;
  }
}

TEST_P(Core, GarbageNeverOutlivesAReset) {
  const auto all = materials(9);
  Random random(9);
  for (int i = 0; i < 60; ++i) {
    for (std::uint32_t words = random.below(2000); words > 0; --words) {
      // Headers of known opcodes are rare among random words: make some.
      const Word word = random.one_in(4) ? (1 + random.below(5)) << kCountBits | random.below(1100)
                                         : random.word();
      core_->offer_command(&word);
      core_->set_answer_ready(!random.one_in(3));
      core_->clock();
    }
    core_->offer_command(nullptr);
    core_->clock(true);
    core_->clock(true);
    const auto words = dense_block(all[2], 1 + random.below(40), random.below(5), true, random);
    ASSERT_EQ(run_core(*core_, words), answers_of_kernel(words)) << "round " << i;
  }
  EXPECT_FALSE(core_->assertion_failed());
}

TEST_P(Core, CountsEveryCycleOnce) {
  core_->clock(true);
  const Material m = materials(6)[0];
  Random random(6);
  std::uint64_t cycles = 0;
  const auto words = dense_block(m, 60 * core_->elements(), 50, true, random);
  run_core(*core_, words, {}, &cycles);
  for (int i = 0; i < 1000; ++i) core_->clock();
  const CycleCount count = cycles_of(*core_);
  EXPECT_EQ(count.busy, 60u * 50u);
  EXPECT_GE(count.idle, 1000u);
  EXPECT_LT(count.idle, 1100u);
  EXPECT_NEAR(static_cast<double>(count.busy + count.stalled + count.idle),
              static_cast<double>(cycles + 1000), 40);
}

TEST_P(Core, ElementsAreBusyOnADenseBlock) {
  const Material m = materials(6)[0];
  Random random(10);
  const std::size_t records = 1000;
  const auto words = dense_block(m, kMaxBlockPoints, records, false, random);
  const CycleCount before = cycles_of(*core_);
  EXPECT_EQ(run_core(*core_, words), answers_of_kernel(words));
  const CycleCount after = cycles_of(*core_);
  const auto busy = static_cast<double>(after.busy - before.busy);
  const double share = busy / (busy + static_cast<double>(after.stalled - before.stalled));
  EXPECT_EQ(after.busy - before.busy, records * kMaxBlockPoints / core_->elements());
  EXPECT_GE(share, 0.90);
  std::printf("%u elements: busy %.2f %%, %.3f pairs a cycle\n", core_->elements(), 100 * share,
              share * core_->elements());
}

INSTANTIATE_TEST_SUITE_P(Elements, Core,
                         testing::ValuesIn(rtl_element_counts().begin(),
                                           rtl_element_counts().end()),
                         testing::PrintToStringParamName());

TEST(RtlDevice, IsADeviceLikeTheTop) {
  const Material m = materials(11)[0];
  Random random(11);
  for (const std::uint32_t elements : rtl_element_counts()) {
    const auto device = make_rtl_device(elements);
    require_compatible(*device);
    const auto words = dense_block(m, 77, 9, true, random);
    for (std::size_t sent = 0; sent < words.size();) {
      const std::size_t cut = std::min<std::size_t>(1 + random.below(50), words.size() - sent);
      device->send(std::span(words).subspan(sent, cut));
      sent += cut;
    }
    const auto expected = answers_of_kernel(words);
    std::vector<Word> answer(expected.size());
    device->receive(answer);
    EXPECT_EQ(answer, expected);
  }
}

// Takes words and gives nothing.
class SilentCore : public CoreSimulation {
 public:
  std::uint32_t elements() const override { return 1; }
  CoreOutputs outputs() const override { return {takes_, false, true, 0}; }
  void offer_command(const Word*) override {}
  void set_answer_ready(bool) override {}
  void clock(bool) override {}
  bool assertion_failed() const override { return false; }
  void set_mutant(std::uint32_t) override {}

  explicit SilentCore(bool takes) : takes_(takes) {}

 private:
  bool takes_;
};

TEST(RtlDevice, SaysWhenNothingComes) {
  std::vector<Word> word = {command_header(kIdentify, 0)};
  RtlDevice silent(std::make_unique<SilentCore>(true));
  silent.send(word);
  EXPECT_THROW(silent.receive(word), Error);
  RtlDevice full(std::make_unique<SilentCore>(false));
  EXPECT_THROW(full.send(word), Error);
  EXPECT_THROW(make_rtl_device()->receive(word), Error);  // nothing was asked
  EXPECT_THROW(make_rtl_device(3), Error);
}

}  // namespace
}  // namespace emax::test
