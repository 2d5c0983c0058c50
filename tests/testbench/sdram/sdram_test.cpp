// sdram_controller with the chip of testbench/sdram/, beside a memory in C++: what is read is what
// was written last, and the chip finds no rule of its data sheet broken. Each mutant breaks its own
// rule.
#include <gtest/gtest.h>

#include <map>
#include <string>
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
#include "testbench/sdram/sdram_driver.h"

namespace emax {
namespace {

TEST(SdramController, ReadsWhatWasWrittenAndBreaksNoRule) {
  SdramBench<Vsdram_120_rtl> at_120;
  EXPECT_EQ(broken_by(at_120, 1u << 14, 4 * kPatterns), 0u);
  SdramBench<Vsdram_105_rtl> at_105;
  EXPECT_EQ(broken_by(at_105, 1u << 14, 2 * kPatterns), 0u);
  SdramBench<Vsdram_90_rtl> at_90;
  EXPECT_EQ(broken_by(at_90, 1u << 16, 2 * kPatterns), 0u);
}

TEST(SdramController, RefreshesWhileNobodyAsks) {
  SdramBench<Vsdram_120_rtl> bench;
  Random random(1);
  const auto requests = any_sdram_requests(500, 1u << 14, random);
  bench.run(requests, Pattern::kAlways, 1);
  bench.idle(1'000'000);
  std::vector<SdramRequest> again = requests;
  for (SdramRequest& request : again) request.write = false;
  bench.run(again, Pattern::kAlways, 2);
  EXPECT_EQ(bench.broken(), 0u);
}

// A word takes two cycles in a run; a row's change some ten, a refresh some twenty in 900.
TEST(SdramController, PassesSixteenBitsACycleInRuns) {
  SdramBench<Vsdram_120_rtl> bench;
  std::vector<SdramRequest> writes, reads;
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
  SdramBench<Vsdram_105_rtl> bench;
  Random random(2);
  for (int round = 0; round < 3; ++round) {
    bench.run(any_sdram_requests(300, 1u << 14, random), Pattern::kMostly, 3);
    bench.idle(random.below(50));
    bench.restart();
  }
  EXPECT_EQ(bench.broken(), 0u);
}

template <class Rtl>
std::uint32_t broken_by_mutant(int mutant) {
  SdramBench<Rtl> bench;
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
