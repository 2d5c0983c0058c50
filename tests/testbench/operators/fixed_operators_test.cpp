// The fixed-point operators beside the arithmetic of hls/kernel/fixed.h: every pair of small
// formats, drawn pairs of large ones, each latency, each family's multiplier, each mutant.
#include <Vfixed_18_16_ecp5_rtl.h>
#include <Vfixed_18_16_nexus_rtl.h>
#include <Vfixed_18_16_rtl.h>
#include <Vfixed_18_16_rtl___024root.h>
#include <Vfixed_18_16_rtl_emax_mutation.h>
#include <Vfixed_18_16_xilinx_rtl.h>
#include <Vfixed_24_20_ecp5_rtl.h>
#include <Vfixed_30_3_rtl.h>
#include <Vfixed_6_3_rtl.h>
#include <Vfixed_6_5_rtl.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include "hls/kernel/fixed.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr std::size_t kFixedLatency = 8;

// The formats of fixed_operators.sv, with its parameters.
struct FixedSetting {
  FixedFormat format, wide, fitted;
};

constexpr auto kUp = Rounding::kHalfUp;
constexpr auto kDown = Rounding::kDown;
constexpr auto kEnds = Overflow::kSaturate;
constexpr auto kWrap = Overflow::kWrap;
constexpr FixedSetting kSmallNearest = {{6, 3, kUp, kEnds}, {9, 4, kUp, kEnds}, {4, 1, kUp, kEnds}};
constexpr FixedSetting kSmallDown = {
    {6, 5, kDown, kWrap}, {8, 3, kDown, kWrap}, {9, 7, kDown, kWrap}};
constexpr FixedSetting k18 = {{18, 16, kUp, kEnds}, {36, 32, kUp, kEnds}, {12, 8, kUp, kEnds}};
constexpr FixedSetting k24 = {{24, 20, kUp, kEnds}, {30, 22, kUp, kEnds}, {12, 8, kUp, kEnds}};
constexpr FixedSetting k30 = {{30, 3, kDown, kEnds}, {60, 8, kDown, kEnds}, {12, 0, kDown, kEnds}};

struct FixedPair {
  std::int64_t a, b;
};

struct FixedResults {
  std::int64_t sum, difference, product, wide, opposite, size, fitted;
  bool less;
  bool operator==(const FixedResults&) const = default;
};

FixedResults results_of(const FixedSetting& setting, const FixedPair& pair) {
  const auto [a, b] = pair;
  const FixedFormat& format = setting.format;
  const auto closed = [&](std::int64_t exact) {
    return fixed_fitted(exact, format.fraction, format);
  };
  return {closed(a + b),
          closed(a - b),
          fixed_fitted(a * b, 2 * format.fraction, format),
          fixed_fitted(a * b, 2 * format.fraction, setting.wide),
          closed(-a),
          closed(a < 0 ? -a : a),
          fixed_fitted(a, format.fraction, setting.fitted),
          a < b};
}

template <class Rtl>
FixedResults shown(const Rtl& rtl, const FixedSetting& setting) {
  const auto number = [](std::uint64_t bits, const FixedFormat& format) {
    return fixed_wrapped(bits, format.width);
  };
  return {number(rtl.sum, setting.format),      number(rtl.difference, setting.format),
          number(rtl.product, setting.format),  number(rtl.wide, setting.wide),
          number(rtl.opposite, setting.format), number(rtl.size, setting.format),
          number(rtl.fitted, setting.fitted),   rtl.less != 0};
}

template <class Port>
void drive(Port& port, std::int64_t number, int width) {
  port = static_cast<Port>(static_cast<std::uint64_t>(number) & ((std::uint64_t{1} << width) - 1));
}

// The number of pairs for which an operator, at any latency, gives something else than the model.
template <class Rtl>
long differences(Rtl& rtl, const FixedSetting& setting, const std::vector<FixedPair>& pairs) {
  long wrong = 0;
  for (std::size_t cycle = 0; cycle < pairs.size() + kFixedLatency; ++cycle) {
    const FixedPair pair = pairs[std::min(cycle, pairs.size() - 1)];
    drive(rtl.a, pair.a, setting.format.width);
    drive(rtl.b, pair.b, setting.format.width);
    rtl.clk = 0;
    rtl.eval();
    if (cycle >= kFixedLatency) {
      wrong += shown(rtl, setting) != results_of(setting, pairs[cycle - kFixedLatency]) ||
               rtl.short_differs != 0 || rtl.multiply_differs != 0;
    }
    rtl.clk = 1;
    rtl.eval();
  }
  return wrong;
}

std::vector<FixedPair> all_fixed_pairs(int width) {
  const std::int64_t end = fixed_greatest(width);
  std::vector<FixedPair> pairs;
  for (std::int64_t a = -end - 1; a <= end; ++a) {
    for (std::int64_t b = -end - 1; b <= end; ++b) pairs.push_back({a, b});
  }
  return pairs;
}

// Of any size, near the ends, and near each other.
std::vector<FixedPair> drawn_fixed_pairs(int width, int count) {
  Random random(named_seed("fixed-point operators", 1));
  const std::int64_t end = fixed_greatest(width);
  const auto drawn = [&] {
    const auto near = static_cast<std::int64_t>(random.below(3));
    if (random.one_in(6)) return random.one_in(2) ? end - near : -end - 1 + near;
    const auto bits =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(random.bits()) >> random.below(64));
    return fixed_wrapped(bits, width);
  };
  std::vector<FixedPair> pairs;
  for (int i = 0; i < count; ++i) {
    const std::int64_t a = drawn();
    const std::int64_t near = std::min(end, a + static_cast<std::int64_t>(random.below(3)));
    pairs.push_back({a, random.one_in(4) ? near : drawn()});
  }
  return pairs;
}

template <class Rtl>
long differences_of_rtl(const FixedSetting& setting, const std::vector<FixedPair>& pairs) {
  VerilatedContext context;
  Rtl rtl(&context);
  return differences(rtl, setting, pairs);
}

TEST(FixedOperators, EveryPairOfSmallFormats) {
  EXPECT_EQ(differences_of_rtl<Vfixed_6_3_rtl>(kSmallNearest, all_fixed_pairs(6)), 0);
  EXPECT_EQ(differences_of_rtl<Vfixed_6_5_rtl>(kSmallDown, all_fixed_pairs(6)), 0);
}

TEST(FixedOperators, DrawnPairsOfLargeFormats) {
  EXPECT_EQ(differences_of_rtl<Vfixed_18_16_rtl>(k18, drawn_fixed_pairs(18, 100000)), 0);
  EXPECT_EQ(differences_of_rtl<Vfixed_30_3_rtl>(k30, drawn_fixed_pairs(30, 100000)), 0);
}

TEST(FixedOperators, EachFamilyGivesTheSame) {
  const auto pairs = drawn_fixed_pairs(18, 100000);
  EXPECT_EQ(differences_of_rtl<Vfixed_18_16_ecp5_rtl>(k18, pairs), 0);
  EXPECT_EQ(differences_of_rtl<Vfixed_18_16_nexus_rtl>(k18, pairs), 0);
  EXPECT_EQ(differences_of_rtl<Vfixed_18_16_xilinx_rtl>(k18, pairs), 0);
  EXPECT_EQ(differences_of_rtl<Vfixed_24_20_ecp5_rtl>(k24, drawn_fixed_pairs(24, 100000)), 0);
}

TEST(FixedOperatorsFault, AnotherFormatIsNoticed) {
  for (const auto& [width, fraction, rounding, overflow] :
       {FixedFormat{6, 3, kDown, kEnds}, FixedFormat{6, 3, kUp, kWrap},
        FixedFormat{6, 2, kUp, kEnds}}) {
    const FixedSetting other = {
        {width, fraction, rounding, overflow}, kSmallNearest.wide, kSmallNearest.fitted};
    EXPECT_GT(differences_of_rtl<Vfixed_6_3_rtl>(other, all_fixed_pairs(6)), 0);
  }
}

TEST(FixedOperators, EveryMutantIsCaught) {
  const auto pairs = drawn_fixed_pairs(18, 2000);
  int tried = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!mutant.module.starts_with("fixed/")) continue;
    ++tried;
    VerilatedContext context;
    Vfixed_18_16_rtl rtl(&context);
    rtl.eval();  // its initial blocks make the design unchanged
    EXPECT_EQ(differences(rtl, k18, pairs), 0);
    rtl.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant.number);
    EXPECT_GT(differences(rtl, k18, pairs), 0) << mutant.name << ": " << mutant.fault;
    Verilated::threadContextp(&context);  // as in verilated_operators.h
  }
  EXPECT_EQ(tried, 8);
}

}  // namespace
}  // namespace emax
