// sdram_controller with the chip of testbench/sdram/, beside a memory in C++: what is read is what
// was written last, and the chip finds no rule of its data sheet broken. Each mutant breaks its own
// rule.
#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "Vsdram_105_rtl.h"
#include "Vsdram_120_rtl.h"
#include "Vsdram_90_rtl.h"
#include "Vsdram_mutated_rtl.h"
#include "Vsdram_mutated_rtl___024root.h"
#include "Vsdram_mutated_rtl_emax_mutation.h"
#include "Vsdram_slow_rtl.h"
#include "Vsdram_slow_rtl___024root.h"
#include "Vsdram_slow_rtl_emax_mutation.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/stimuli/stream_pattern.h"

namespace emax {
namespace {

// The bits of sdram_chip's `broken`.
enum Rule : unsigned {
  kStart,
  kOrder,
  kMode,
  kMrd,
  kRcd,
  kRp,
  kRas,
  kRc,
  kRfc,
  kWr,
  kRefreshed,
  kRow,
  kBurst,
  kBus,
  kData,
  kCommand,
  kWords = 31,  // words that differ from the memory's in C++, or do not come
};

struct Request {
  bool write;
  std::uint32_t address;
  std::uint32_t data;
};

// Runs of words within rows and over their ends, single words anywhere, reads after writes of the
// same words; few rows, so that they come back.
std::vector<Request> any_requests(std::size_t count, std::uint32_t words, Random& random) {
  std::vector<Request> requests;
  while (requests.size() < count) {
    const bool write = random.one_in(2);
    std::uint32_t address =
        random.one_in(2) && !requests.empty() ? requests.back().address & ~7u : random.below(words);
    if (random.one_in(4)) address |= 0xf8u;  // the next row is near
    for (std::uint32_t left = 1 + random.below(random.one_in(4) ? 60 : 4); left > 0; --left) {
      requests.push_back({write, address++ % words, random.word()});
    }
  }
  return requests;
}

template <class Rtl>
class Bench {
 public:
  Bench() : rtl_(&context_) {
    context_.fatalOnError(false);
    rtl_.request_valid = 0;
    restart();
  }
  ~Bench() {
    Verilated::threadContextp(&context_);
    rtl_.final();
  }

  Rtl& rtl() { return rtl_; }

  void restart() {
    rtl_.aresetn = 0;
    for (int i = 0; i < 4; ++i) clock();
    rtl_.aresetn = 1;
    expected_.clear();
  }

  // Carries the requests out, each read compared with the memory in C++. Returns the cycles.
  std::uint64_t run(const std::vector<Request>& requests, Pattern pattern, std::uint64_t seed) {
    PatternSource willing(pattern, seed);
    std::uint64_t cycles = 0, silent = 0;
    for (auto next = requests.begin(); next != requests.end() || !expected_.empty(); ++cycles) {
      if (!rtl_.request_valid && next != requests.end() && willing.next()) show(*next);
      const bool taken = rtl_.request_valid && rtl_.request_ready;
      silent = taken || rtl_.read_valid ? 0 : silent + 1;
      if (silent > kPatience) {
        wrong_ = true;
        return cycles;
      }
      if (taken) note(*next++);
      take_word();
      clock();
      if (taken) rtl_.request_valid = 0;
    }
    for (int i = 0; i < 100; ++i) {  // no word comes that nobody asked for
      take_word();
      clock();
    }
    return cycles;
  }

  void idle(std::uint64_t cycles) {
    for (; cycles > 0; --cycles) clock();
  }

  std::uint32_t broken() const { return rtl_.broken | (wrong_ ? 1u << kWords : 0u); }

 private:
  static constexpr std::uint64_t kPatience = 40000;  // more than the start takes

  void show(const Request& request) {
    rtl_.request_valid = 1;
    rtl_.request_write = request.write;
    rtl_.request_address =
        static_cast<std::remove_reference_t<decltype(rtl_.request_address)>>(request.address);
    rtl_.request_data = request.data;
  }

  void note(const Request& request) {
    if (request.write) {
      memory_[request.address] = request.data;
    } else {
      const auto known = memory_.find(request.address);
      expected_.push_back(known == memory_.end() ? std::nullopt : std::optional(known->second));
    }
  }

  void take_word() {
    if (!rtl_.read_valid) return;
    if (expected_.empty()) {
      wrong_ = true;
      return;
    }
    wrong_ = wrong_ || (expected_.front() && *expected_.front() != rtl_.read_data);
    expected_.pop_front();
  }

  void clock() {
    rtl_.clk = 1;
    rtl_.eval();
    rtl_.clk = 0;
    rtl_.eval();
    context_.timeInc(2);
  }

  VerilatedContext context_;
  Rtl rtl_;
  std::map<std::uint32_t, std::uint32_t> memory_;
  std::deque<std::optional<std::uint32_t>> expected_;  // none where a word was never written
  bool wrong_ = false;
};

template <class Rtl>
std::uint32_t broken_by(Bench<Rtl>& bench, std::uint32_t words, std::size_t rounds) {
  Random random(named_seed("broken_by", words));
  for (std::uint32_t round = 0; round < rounds && bench.broken() == 0; ++round) {
    const auto pattern = static_cast<Pattern>(round % kPatterns);
    bench.run(any_requests(2000, words, random), pattern, round);
  }
  return bench.broken();
}

TEST(SdramController, ReadsWhatWasWrittenAndBreaksNoRule) {
  Bench<Vsdram_120_rtl> at_120;
  EXPECT_EQ(broken_by(at_120, 1u << 14, 4 * kPatterns), 0u);
  Bench<Vsdram_105_rtl> at_105;
  EXPECT_EQ(broken_by(at_105, 1u << 14, 2 * kPatterns), 0u);
  Bench<Vsdram_90_rtl> at_90;
  EXPECT_EQ(broken_by(at_90, 1u << 16, 2 * kPatterns), 0u);
}

TEST(SdramController, RefreshesWhileNobodyAsks) {
  Bench<Vsdram_120_rtl> bench;
  Random random(1);
  const auto requests = any_requests(500, 1u << 14, random);
  bench.run(requests, Pattern::kAlways, 1);
  bench.idle(1'000'000);
  std::vector<Request> again = requests;
  for (Request& request : again) request.write = false;
  bench.run(again, Pattern::kAlways, 2);
  EXPECT_EQ(bench.broken(), 0u);
}

// A word takes two cycles in a run; a row's change some ten, a refresh some twenty in 900.
TEST(SdramController, PassesSixteenBitsACycleInRuns) {
  Bench<Vsdram_120_rtl> bench;
  std::vector<Request> writes, reads;
  for (std::uint32_t i = 0; i < 8192; ++i) {
    writes.push_back({true, i, i * 0x9e3779b9u});
    reads.push_back({false, i, 0});
  }
  bench.run({{true, 0, 0}}, Pattern::kAlways, 1);  // after the start
  bench.idle(30'000);
  const std::uint64_t writing = bench.run(writes, Pattern::kAlways, 1);
  const std::uint64_t reading = bench.run(reads, Pattern::kAlways, 1);
  EXPECT_EQ(bench.broken(), 0u);
  EXPECT_GT(writing, 2u * 8192);
  EXPECT_LT(writing, 2u * 8192 * 108 / 100);
  EXPECT_GT(reading, 2u * 8192);
  EXPECT_LT(reading, 2u * 8192 * 108 / 100);
}

TEST(SdramController, ARestartForgetsRequestsAndStartsAnew) {
  Bench<Vsdram_105_rtl> bench;
  Random random(2);
  for (int round = 0; round < 3; ++round) {
    bench.run(any_requests(300, 1u << 14, random), Pattern::kMostly, 3);
    bench.idle(random.below(50));
    bench.restart();
  }
  EXPECT_EQ(bench.broken(), 0u);
}

template <class Rtl>
std::uint32_t broken_by_mutant(int mutant) {
  Bench<Rtl> bench;
  bench.rtl().rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  bench.restart();
  return broken_by(bench, 1u << 14, 2 * kPatterns);
}

TEST(SdramMutants, EachBreaksItsRule) {
  const std::map<std::string, unsigned> rules = {
      {"SDRAM_STARTS_EARLY", kStart},     {"SDRAM_FEW_REFRESHES", kOrder},
      {"SDRAM_MODE_LEFT_OUT", kOrder},    {"SDRAM_ONE_HALF_BURSTS", kMode},
      {"SDRAM_CLOSES_ITSELF", kCommand},  {"SDRAM_MODE_SHORT", kMrd},
      {"SDRAM_ROW_SHORT", kRcd},          {"SDRAM_PRECHARGE_SHORT", kRp},
      {"SDRAM_ACTIVE_SHORT", kRas},       {"SDRAM_CYCLE_SHORT", kRc},
      {"SDRAM_REFRESH_SHORT", kRfc},      {"SDRAM_RECOVERY_SHORT", kWr},
      {"SDRAM_REFRESH_LATE", kRefreshed}, {"SDRAM_REFRESH_OPEN", kRow},
      {"SDRAM_TURN_SHORT", kBus},         {"SDRAM_BURST_CUT", kBurst},
      {"SDRAM_KEEPS_ROW", kWords},        {"SDRAM_HALVES_SWAPPED", kWords},
      {"SDRAM_READS_EARLY", kWords},      {"SDRAM_DRIVES_ONCE", kData}};
  EXPECT_EQ(broken_by_mutant<Vsdram_mutated_rtl>(0), 0u);
  EXPECT_EQ(broken_by_mutant<Vsdram_slow_rtl>(0), 0u);
  std::size_t mutants = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!mutant.module.starts_with("sdram/")) continue;
    ++mutants;
    ASSERT_TRUE(rules.contains(mutant.name)) << mutant.name;
    const std::uint32_t broken = mutant.name == "SDRAM_CYCLE_SHORT"
                                     ? broken_by_mutant<Vsdram_slow_rtl>(mutant.number)
                                     : broken_by_mutant<Vsdram_mutated_rtl>(mutant.number);
    EXPECT_NE(broken & 1u << rules.at(mutant.name), 0u) << mutant.name << " breaks " << broken;
  }
  EXPECT_EQ(mutants, rules.size());
}

}  // namespace
}  // namespace emax
