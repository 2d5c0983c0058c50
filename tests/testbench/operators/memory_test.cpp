#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "Vbehavioural_memory_rtl.h"
#include "Vecp5_deep_memory_rtl.h"
#include "Vecp5_few_words_rtl.h"
#include "Vecp5_memory_11_rtl.h"
#include "Vecp5_memory_12_rtl.h"
#include "Vecp5_memory_13_rtl.h"
#include "Vecp5_memory_14_rtl.h"
#include "Vecp5_memory_rtl.h"
#include "Vmemories_rtl.h"
#include "Vmemories_rtl___024root.h"
#include "Vmemories_rtl_emax_mutation.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr std::array<int, 10> kDepths = {0, 1, 2, 3, 4, 17, 18, 34, 35, 52};
constexpr int kCycles = 3000;

class Memories {
 public:
  explicit Memories(int mutant) : rtl_(&context_) {
    rtl_.eval();  // its initial blocks make the design unchanged
    rtl_.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  }
  Vmemories_rtl& rtl() { return rtl_; }
  void clock() {
    rtl_.clk = 0;
    rtl_.eval();
    rtl_.clk = 1;
    rtl_.eval();
  }

 private:
  VerilatedContext context_;
  Vmemories_rtl rtl_;
};

template <class Packed>
unsigned byte(const Packed& packed, std::size_t i) {
  return packed[i / 4] >> (8 * (i % 4)) & 255u;
}

// Outputs that were not the input of DEPTH edges ago, by style.
std::array<int, 4> late_or_early(int mutant) {
  Memories memories(mutant);
  Vmemories_rtl& rtl = memories.rtl();
  Random random(named_seed("late_or_early", 1));
  std::vector<unsigned> history;
  std::array<int, 4> wrong = {};
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    rtl.d = static_cast<CData>(random.below(256));
    history.push_back(rtl.d);
    memories.clock();
    for (std::size_t i = 0; i < kDepths.size(); ++i) {
      // Just after an edge, depth 0 still shows this input and depth 1 holds it.
      const int back = std::max(kDepths[i] - 1, 0);
      if (back > cycle) continue;
      const unsigned expected = history[history.size() - 1 - static_cast<std::size_t>(back)];
      wrong[0] += byte(rtl.registers, i) != expected;
      wrong[1] += byte(rtl.shift_register, i) != expected;
      wrong[2] += byte(rtl.distributed_ram, i) != expected;
      wrong[3] += byte(rtl.block_ram, i) != expected;
    }
  }
  return wrong;
}

int wrong_words(int mutant) {
  Memories memories(mutant);
  Vmemories_rtl& rtl = memories.rtl();
  Random random(named_seed("wrong_words", 1));
  std::array<unsigned, 8> words = {};
  for (unsigned slot = 0; slot < 8; ++slot) {
    rtl.write_enable = 1;
    rtl.write_slot = static_cast<CData>(slot);
    words[slot] = rtl.write_data = static_cast<SData>(random.below(65536));
    memories.clock();
  }
  int wrong = 0;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    rtl.write_enable = random.one_in(2);
    rtl.write_slot = static_cast<CData>(random.below(8));
    rtl.write_data = static_cast<SData>(random.below(65536));
    rtl.read_slot = random.one_in(3) ? rtl.write_slot : static_cast<CData>(random.below(8));
    const unsigned expected = words[rtl.read_slot];  // a read at the edge of a write gives the old
    if (rtl.write_enable) words[rtl.write_slot] = rtl.write_data;
    memories.clock();
    wrong += rtl.read_data != expected;
  }
  return wrong;
}

int mutant_number(const std::string& name) {
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST))
    if (mutant.name == name) return mutant.number;
  ADD_FAILURE() << name << " is not in hls/rtl/mutation.sv";
  return 0;
}

TEST(DelayLine, EveryStyleDelaysByItsDepth) {
  EXPECT_EQ(late_or_early(0), (std::array<int, 4>{0, 0, 0, 0}));
}

TEST(DelayLine, OneEdgeShortIsSeen) {
  const std::array<int, 4> wrong = late_or_early(mutant_number("DELAY_ONE_SHORT"));
  EXPECT_GT(wrong[2], kCycles);
  EXPECT_EQ(wrong[0] + wrong[1] + wrong[3], 0);
}

TEST(FieldMemory, ReadsWhatWasWritten) { EXPECT_EQ(wrong_words(0), 0); }

TEST(FieldMemory, WriteWithoutEnableIsSeen) {
  EXPECT_GT(wrong_words(mutant_number("FIELD_ALWAYS_WRITTEN")), 100);
}

// Words that differ from those of an array with two registers behind it; what a read gives that
// meets a write of its address is left out.
template <class Rtl, std::uint32_t kWords = 512>
int wrong_block_words() {
  VerilatedContext context;
  Rtl rtl(&context);
  using Address = std::remove_reference_t<decltype(rtl.write_address)>;
  Random random(named_seed("wrong_block_words", 1));
  std::array<std::optional<std::uint64_t>, kWords> words;
  std::optional<std::uint64_t> fetched, expected;
  int wrong = 0, compared = 0;
  for (int cycle = 0; cycle < 20 * kCycles; ++cycle) {
    rtl.write_enable = random.one_in(2);
    rtl.write_address = static_cast<Address>(random.below(kWords));
    rtl.write_data = random.bits() & 0x1'ffff'ffff;
    rtl.read_enable = !random.one_in(3);
    rtl.read_address = static_cast<Address>(random.below(kWords));
    rtl.output_enable = !random.one_in(3);
    if (rtl.output_enable) expected = fetched;
    if (rtl.read_enable) {
      fetched = words[rtl.read_address];
      if (rtl.write_enable && rtl.write_address == rtl.read_address) fetched.reset();
    }
    if (rtl.write_enable) words[rtl.write_address] = rtl.write_data;
    for (const int level : {0, 1}) {
      rtl.clk = static_cast<CData>(level);
      rtl.eval();
    }
    if (!expected) continue;
    ++compared;
    wrong += rtl.read_data != *expected;
  }
  EXPECT_GT(compared, kCycles);
  return wrong;
}

TEST(BlockMemory, ReadsWhatWasWritten) {
  EXPECT_EQ(wrong_block_words<Vbehavioural_memory_rtl>(), 0);
}

TEST(BlockMemory, MappedOntoEcp5ReadsWhatWasWritten) {
  EXPECT_EQ(wrong_block_words<Vecp5_memory_rtl>(), 0);
  EXPECT_EQ((wrong_block_words<Vecp5_memory_11_rtl, 2048>()), 0);
  EXPECT_EQ((wrong_block_words<Vecp5_memory_12_rtl, 4096>()), 0);
  EXPECT_EQ((wrong_block_words<Vecp5_memory_13_rtl, 8192>()), 0);
  EXPECT_EQ((wrong_block_words<Vecp5_memory_14_rtl, 16384>()), 0);
  EXPECT_EQ((wrong_block_words<Vecp5_deep_memory_rtl, 32768>()), 0);
  EXPECT_EQ((wrong_block_words<Vecp5_few_words_rtl, 32>()), 0);
}

}  // namespace
}  // namespace emax
