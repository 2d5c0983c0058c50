// fp_divide and fp_square_root: every pair of two small formats, and binary32 beside the processor
// and the model's scalar.
#include <Vdivision_4_3_rtl.h>
#include <Vdivision_5_2_rtl.h>
#include <Vdivision_every_rtl.h>
#include <Vdivision_mutant_rtl.h>
#include <Vdivision_mutant_rtl___024root.h>
#include <Vdivision_mutant_rtl_emax_mutation.h>
#include <Vdivision_rtl.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <cmath>

#include "sw_model/base/float_bits.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/model/flushed_float.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/operators/operator_reference.h"
#include "testbench/operators/operator_stimuli.h"

namespace emax {
namespace {

struct DivisionResults {
  std::uint32_t quotient, root;
  bool operator==(const DivisionResults&) const = default;
};

// A result for every pair, `latency` cycles after it.
template <class Rtl>
std::vector<DivisionResults> results_of(Rtl& rtl, std::span<const OperandPair> pairs, int latency) {
  std::vector<DivisionResults> results;
  const auto cycles = pairs.size() + static_cast<std::size_t>(latency);
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
    const OperandPair pair = cycle < pairs.size() ? pairs[cycle] : OperandPair{0, 0};
    rtl.a = static_cast<std::remove_reference_t<decltype(rtl.a)>>(pair.a);
    rtl.b = static_cast<std::remove_reference_t<decltype(rtl.b)>>(pair.b);
    rtl.clk = 0;
    rtl.eval();
    if (cycle >= static_cast<std::size_t>(latency)) results.push_back({rtl.quotient, rtl.root});
    rtl.clk = 1;
    rtl.eval();
  }
  return results;
}

std::string described(const OperandPair& pair, const DivisionResults& result,
                      const DivisionResults& expected) {
  return describe_bits(pair.a) + " by " + describe_bits(pair.b) + ": quotient " +
         describe_bits(result.quotient) + " for " + describe_bits(expected.quotient) + ", root " +
         describe_bits(result.root) + " for " + describe_bits(expected.root);
}

// The first difference as text; empty if there is none.
std::string first_difference(std::span<const OperandPair> pairs,
                             std::span<const DivisionResults> results,
                             std::span<const DivisionResults> expected) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (results[i] != expected[i]) return described(pairs[i], results[i], expected[i]);
  }
  return "";
}

std::vector<OperandPair> all_pairs(const SmallFormat& format) {
  std::vector<OperandPair> pairs;
  const std::uint32_t end = 1u << format.width();
  for (std::uint32_t a = 0; a < end; ++a) {
    for (std::uint32_t b = 0; b < end; ++b) pairs.push_back({a, b});
  }
  return pairs;
}

// binary64 has more than twice the digits and two more, so rounding its result once more is exact.
std::vector<DivisionResults> expected_of(const SmallFormat& format,
                                         std::span<const OperandPair> pairs) {
  std::vector<DivisionResults> results;
  for (const OperandPair& pair : pairs) {
    const double a = format.value(pair.a), b = format.value(pair.b);
    results.push_back({format.rounded(a / b), format.rounded(std::sqrt(a))});
  }
  return results;
}

TEST(Division, EveryPairOfSmallFormats) {
  const SmallFormat four{4, 3}, five{5, 2};
  VerilatedContext context;
  Vdivision_4_3_rtl rtl_four(&context);
  const auto pairs = all_pairs(four);
  EXPECT_EQ(first_difference(pairs, results_of(rtl_four, pairs, 7), expected_of(four, pairs)), "");
  Vdivision_5_2_rtl rtl_five(&context);
  EXPECT_EQ(first_difference(pairs, results_of(rtl_five, pairs, 6), expected_of(five, pairs)), "");
  EXPECT_NE(first_difference(pairs, results_of(rtl_five, pairs, 6), expected_of(four, pairs)), "");
}

std::vector<OperandPair> binary32_pairs(std::uint64_t seed, std::size_t each) {
  Random random(seed);
  std::vector<OperandPair> pairs = corner_pairs(), more(each);
  for (int aim = 0; aim < kAims; ++aim) {
    fill_pairs(static_cast<Aim>(aim), random, more);
    pairs.insert(pairs.end(), more.begin(), more.end());
    // The aims are products'; a quotient by the inverse exponent has the same ones.
    for (OperandPair& pair : more)
      pair.b = (pair.b & 0x807fffffu) | (0x7f000000u - (pair.b & 0x7f800000u));
    pairs.insert(pairs.end(), more.begin(), more.end());
  }
  return pairs;
}

std::vector<DivisionResults> model_results(std::span<const OperandPair> pairs) {
  std::vector<DivisionResults> results;
  for (const OperandPair& pair : pairs) {
    const FlushedFloat a(bits_float(pair.a)), b(bits_float(pair.b));
    results.push_back({to_word(a / b), to_word(square_root(a))});
  }
  return results;
}

std::uint32_t one_nan(float value) {
  return is_nan_bits(float_bits(value)) ? kCanonicalNan : float_bits(value);
}

std::vector<DivisionResults> processor_results(std::span<const OperandPair> pairs) {
  const ScopedFlushMode flush;
  std::vector<DivisionResults> results;
  for (const OperandPair& pair : pairs) {
    const volatile float a = bits_float(pair.a), b = bits_float(pair.b);
    results.push_back({one_nan(a / b), one_nan(std::sqrt(a))});
  }
  return results;
}

TEST(Division, BinaryResultsAreThoseOfModelAndProcessor) {
  const auto pairs =
      binary32_pairs(named_seed("BinaryResultsAreThoseOfModelAndProcessor", 1), 8000);
  VerilatedContext context;
  Vdivision_rtl rtl(&context);
  const auto expected = model_results(pairs);
  EXPECT_EQ(first_difference(pairs, results_of(rtl, pairs, 27), expected), "");
  EXPECT_EQ(first_difference(pairs, processor_results(pairs), expected), "");
}

TEST(Division, ResultsAreTheSameAtEveryLatency) {
  VerilatedContext context;
  Vdivision_every_rtl rtl(&context);
  unsigned divide = 0, root = 0;
  int cycle = 0;
  for (const OperandPair& pair : binary32_pairs(7, 40)) {
    rtl.a = pair.a;
    rtl.b = pair.b;
    for (const int clock : {0, 1}) {
      rtl.clk = clock != 0;
      rtl.eval();
    }
    if (++cycle < 30) continue;
    divide |= rtl.divide_differs;
    root |= rtl.root_differs;
  }
  EXPECT_EQ(divide, 0u) << "bit LATENCY - 1";
  EXPECT_EQ(root, 0u) << "bit LATENCY - 1";
}

TEST(Division, EveryMutantIsCaught) {
  const auto pairs = binary32_pairs(8, 400);
  const auto expected = model_results(pairs);
  int tried = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!mutant.module.starts_with("division/")) continue;
    ++tried;
    VerilatedContext context;
    Vdivision_mutant_rtl rtl(&context);
    rtl.eval();  // its initial blocks make the design unchanged
    EXPECT_EQ(first_difference(pairs, results_of(rtl, pairs, 27), expected), "");
    rtl.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant.number);
    EXPECT_NE(first_difference(pairs, results_of(rtl, pairs, 27), expected), "") << mutant.name;
    Verilated::threadContextp(&context);  // as in verilated_operators.h
  }
  EXPECT_EQ(tried, 9);
}

}  // namespace
}  // namespace emax
