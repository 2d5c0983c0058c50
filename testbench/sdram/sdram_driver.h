// What drives sdram_bench.sv, of any Verilated variant: requests beside a memory in C++, and what
// the chip finds.
#pragma once

#include <verilated.h>

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <type_traits>
#include <vector>

#include "testbench/stimuli/stream_pattern.h"

namespace emax {

// The bits of sdram_chip's `broken`.
enum SdramRule : unsigned {
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

struct SdramRequest {
  bool write;
  std::uint32_t address;
  std::uint32_t data;
};

// Runs of words within rows and over their ends, single words anywhere, reads after writes of the
// same words; few rows, so that they come back.
inline std::vector<SdramRequest> any_sdram_requests(std::size_t count, std::uint32_t words,
                                                    Random& random) {
  std::vector<SdramRequest> requests;
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

// `Rtl` is a class made by Verilator from sdram_bench.
template <class Rtl>
class SdramBench {
 public:
  SdramBench() : rtl_(&context_) {
    context_.fatalOnError(false);
    rtl_.request_valid = 0;
    restart();
  }
  ~SdramBench() {
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
  std::uint64_t run(const std::vector<SdramRequest>& requests, Pattern pattern,
                    std::uint64_t seed) {
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

  void show(const SdramRequest& request) {
    rtl_.request_valid = 1;
    rtl_.request_write = request.write;
    rtl_.request_address =
        static_cast<std::remove_reference_t<decltype(rtl_.request_address)>>(request.address);
    rtl_.request_data = request.data;
  }

  void note(const SdramRequest& request) {
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

// The rules that random requests for the first `words` break, as bits.
template <class Rtl>
std::uint32_t broken_by(SdramBench<Rtl>& bench, std::uint32_t words, std::size_t rounds) {
  Random random(named_seed("broken_by", words));
  for (std::uint32_t round = 0; round < rounds && bench.broken() == 0; ++round) {
    const auto pattern = static_cast<Pattern>(round % kPatterns);
    bench.run(any_sdram_requests(2000, words, random), pattern, round);
  }
  return bench.broken();
}

}  // namespace emax
