// The Verilated cores of a board behind their store beside the twin in C++, bit for bit.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>
#include <string>
#include <utility>

#include "sw_model/base/error.h"
#include "sw_model/protocol/cycle_model.h"
#include "testbench/core/board_stimuli.h"
#include "testbench/core/core_driver.h"
#include "testbench/core/rtl_device.h"
#include "testbench/operators/mutant_list.h"

namespace emax::test {
namespace {

TEST(DeviceCore, AnswersAnyCommandsAsItsTwin) {
  const auto exact = materials(5);
  const FilterMaterial filter = filter_material(5);
  const auto core = make_device();
  std::size_t answered = 0;
  for (std::uint32_t round = 0; round < 2 * kPatterns; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Random random(round);
    const auto words =
        any_board_commands(exact[round % exact.size()], filter, 25, kRtlBoardStoreBits, random);
    const auto expected = answers_of_board(words, kRtlBoardStoreBits);
    const CorePatterns patterns = {static_cast<Pattern>(round % kPatterns),
                                   static_cast<Pattern>((round + round / kPatterns) % kPatterns),
                                   round};
    ASSERT_EQ(run_core(*core, words, patterns), expected);
    answered += expected.size();
  }
  EXPECT_GT(answered, 2000u);
}

TEST(DeviceCore, SaysWhatItsPartsAre) {
  const auto core = make_device();
  const std::vector<Word> words = {command_header(kIdentify, kOfExact),
                                   command_header(kIdentify, kOfFilter),
                                   command_header(kIdentify, kOfStore)};
  const Word five = command_header(kIdentify, kAnswerIdentity);
  const std::vector<Word> expected = {five,
                                      kKernelVersion,
                                      1024,
                                      kRecordWords,
                                      1,
                                      0,
                                      five,
                                      kFilterVersion,
                                      1024,
                                      kFilterRecordWords,
                                      kRtlBoardFilterElements,
                                      0,
                                      command_header(kIdentify, kAnswerStore),
                                      kStoreVersion,
                                      1u << kRtlBoardStoreBits};
  EXPECT_EQ(run_core(*core, words), expected);
  // Each core counts its own cycles.
  const auto counted = run_core(*core, std::vector<Word>{command_header(kCounters, kOfExact),
                                                         command_header(kCounters, kOfFilter)});
  EXPECT_EQ(counted.size(), 2u * (1 + kAnswerCounters));
}

bool keeps_words_over_a_reset(CoreSimulation& core) {
  EXPECT_TRUE(run_core(core, std::vector<Word>{command_header(kStore, 3), 100, 7, 8}).empty());
  core.clock(true);
  core.clock(true);
  const std::vector<Word> echo = {command_header(kRecall, 2), command_header(kEcho, 2),
                                  store_piece(100, 2)};
  return run_core(core, echo) == std::vector<Word>{command_header(kEcho, 2), 7, 8};
}

TEST(DeviceCore, KeepsItsWordsOverAReset) { EXPECT_TRUE(keeps_words_over_a_reset(*make_device())); }

// Whether the core answers rightly after a reset that comes between any words of other commands.
bool resets_in_mid_stream(CoreSimulation& core, std::uint32_t seed, unsigned store_bits) {
  static const auto exact = materials(6);
  static const FilterMaterial filter = filter_material(6);
  Random random(seed);
  const auto broken = any_board_commands(exact[seed % exact.size()], filter, 4, store_bits, random);
  const std::size_t cut = random.below(broken.size());
  for (std::size_t sent = 0; sent < cut;) {
    core.offer_command(&broken[sent]);
    core.set_answer_ready(random.one_in(2));
    sent += core.outputs().command_ready ? 1 : 0;
    core.clock();
  }
  core.offer_command(nullptr);
  core.clock(true);
  core.clock(true);
  const auto words = any_board_commands(exact[0], filter, 3, store_bits, random);
  return run_core(core, words) == answers_of_board(words, store_bits);
}

TEST(DeviceCore, ResetInMidStreamLeavesNothingBehind) {
  const auto core = make_device();
  for (std::uint32_t i = 0; i < 20; ++i)
    ASSERT_TRUE(resets_in_mid_stream(*core, i, kRtlBoardStoreBits));
}

TEST(DeviceWithSdram, AnswersAnyCommandsAsItsTwin) {
  const auto exact = materials(8);
  const FilterMaterial filter = filter_material(8);
  const auto core = make_mutated_device_with_sdram();
  for (std::uint32_t round = 0; round < kPatterns; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Random random(round);
    const auto words =
        any_board_commands(exact[round % exact.size()], filter, 25, kSdramStoreBits, random);
    const CorePatterns patterns = {static_cast<Pattern>(round),
                                   static_cast<Pattern>((round + 1) % kPatterns), round};
    ASSERT_EQ(run_core(*core, words, patterns), answers_of_board(words, kSdramStoreBits));
  }
  EXPECT_EQ(run_core(*core, std::vector<Word>{command_header(kIdentify, kOfStore)}),
            (std::vector<Word>{command_header(kIdentify, kAnswerStore), kStoreVersion,
                               1u << kSdramStoreBits}));
}

// The cycles that the model has for recalls, of long pieces and of short ones in rows far apart.
TEST(DeviceWithSdram, RecallsInTheModelsCycles) {
  const auto core = make_mutated_device_with_sdram();
  EXPECT_TRUE(keeps_words_over_a_reset(*core));  // the chip has been started
  const auto cycles_of = [&](Word pieces, Word length) {
    std::vector<Word> words = {command_header(kRecall, 1 + pieces),
                               command_header(kEcho, pieces * length)};
    for (Word i = 0; i < pieces; ++i) {
      words.push_back(store_piece(i * 1040 % (1u << kSdramStoreBits), length));
    }
    std::uint64_t cycles = 0;
    EXPECT_EQ(run_core(*core, words, {}, &cycles).size(), 1 + pieces * length);
    return static_cast<double>(cycles);
  };
  for (const auto& [pieces, length] :
       {std::pair<Word, Word>{3, 1000}, {8, 500}, {100, 22}, {300, 8}}) {
    const double taken = cycles_of(pieces, length), none = cycles_of(1, 1);
    const double model = sdram_recall_cycles(pieces * length, pieces) - sdram_recall_cycles(1, 1);
    std::printf("%u pieces of %u words: %.0f cycles, %.0f by the model\n", pieces, length,
                taken - none, model);
    EXPECT_NEAR((taken - none) / model, 1, 0.01);
  }
}

TEST(DeviceWithSdram, KeepsItsWordsOverAReset) {
  const auto core = make_mutated_device_with_sdram();
  EXPECT_TRUE(keeps_words_over_a_reset(*core));
}

TEST(DeviceWithSdram, ResetInMidStreamLeavesNothingBehind) {
  const auto core = make_mutated_device_with_sdram();
  for (std::uint32_t i = 0; i < 60; ++i)
    ASSERT_TRUE(resets_in_mid_stream(*core, i, kSdramStoreBits));
}

bool is_caught(CoreSimulation& core, unsigned store_bits, std::uint32_t mutant) {
  core.set_mutant(mutant);
  core.clock(true);
  const auto exact = materials(7);
  const FilterMaterial filter = filter_material(7);
  Random random(7);
  const auto words = any_board_commands(exact[0], filter, 30, store_bits, random);
  try {
    if (run_core(core, words) != answers_of_board(words, store_bits)) return true;
    for (std::uint32_t i = 0; i < 60; ++i) {
      if (!resets_in_mid_stream(core, i, store_bits)) return true;
    }
    return false;
  } catch (const Error&) {
    return true;  // an assertion, or no end
  }
}

bool is_caught(std::uint32_t mutant) {
  return is_caught(*make_mutated_device(), kMutatedStoreBits, mutant);
}
bool is_caught_with_sdram(std::uint32_t mutant) {
  return is_caught(*make_mutated_device_with_sdram(), kSdramStoreBits, mutant);
}

const std::set<std::string> kOfSdram = {"STORE_OVERTAKES", "STORE_KEEPS_STALE_WORDS"};

TEST(DeviceCoreMutants, EachIsCaught) {
  EXPECT_FALSE(is_caught(0));
  EXPECT_FALSE(is_caught_with_sdram(0));
  std::size_t mutants = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!mutant.module.starts_with("board/")) continue;
    ++mutants;
    const auto number = static_cast<std::uint32_t>(mutant.number);
    // Some faults are of the one memory or the other.
    const bool of_sdram = kOfSdram.contains(mutant.name);
    EXPECT_EQ(is_caught(number), !of_sdram) << mutant.name;
    EXPECT_TRUE(is_caught_with_sdram(number)) << mutant.name;
  }
  EXPECT_EQ(mutants, 3u + kOfSdram.size());
}

}  // namespace
}  // namespace emax::test
