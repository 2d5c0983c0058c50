#include <gtest/gtest.h>

#include <bit>
#include <cstdio>
#include <memory>
#include <set>

#include "sw_model/base/float_bits.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/operators/operator_cosim.h"
#include "testbench/operators/operator_stimuli.h"
#include "testbench/operators/operator_unit.h"

namespace emax {
namespace {

std::string mismatches_of(const OperatorRun& run) {
  std::string text;
  for (const OperatorResult& result : run) {
    if (result.mismatches != 0) text += result.first_mismatch + "\n";
  }
  return text;
}

TEST(OperatorCosim, BinaryOperatorsAgreeWithTheProcessor) {
  const std::uint64_t seed = named_seed("BinaryOperatorsAgreeWithTheProcessor", 1);
  const OperatorRun run = run_operator_cosim(*make_operators_8_23(), 300'000, seed);
  EXPECT_EQ(mismatches_of(run), "") << "seed " << seed;
  EXPECT_EQ(run[0].pairs, 300'000 + corner_pairs().size());
}

TEST(OperatorCosim, EveryPairOfFourExponentAndThreeFractionBits) {
  const OperatorRun run = run_small_cosim(*make_operators_4_3(), {4, 3});
  EXPECT_EQ(mismatches_of(run), "");
  EXPECT_EQ(run[0].pairs, 1u << 16);
}

TEST(OperatorCosim, EveryPairOfFiveExponentAndTwoFractionBits) {
  const OperatorRun run = run_small_cosim(*make_operators_5_2(), {5, 2});
  EXPECT_EQ(mismatches_of(run), "");
  EXPECT_EQ(run[0].pairs, 1u << 16);
}

TEST(OperatorCosim, FormatsAreToldApart) {
  EXPECT_NE(mismatches_of(run_small_cosim(*make_operators_4_3(), {5, 2})), "");
}

TEST(OperatorCosim, MutantBuildWithoutMutantIsTheDesign) {
  const std::uint64_t seed = named_seed("MutantBuildWithoutMutantIsTheDesign", 1);
  EXPECT_EQ(mismatches_of(run_operator_cosim(*make_mutant_operators(0), 100'000, seed)), "");
}

// What drives no pairs through the operators is caught in memory_test and multiplier_test.
bool is_an_operator(const std::string& module) {
  return module.starts_with("fp_") || module == "delay_line";
}

TEST(OperatorCosim, EveryMutantIsCaught) {
  const std::uint64_t seed = named_seed("EveryMutantIsCaught", 1);
  std::size_t tried = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!is_an_operator(mutant.module)) continue;
    ++tried;
    const OperatorRun run =
        run_operator_cosim(*make_mutant_operators(mutant.number), 100'000, seed, true);
    std::string caught_by;
    for (int o = 0; o < kOperators; ++o) {
      if (run[static_cast<std::size_t>(o)].mismatches != 0)
        caught_by += std::string(" ") + operator_name(static_cast<Operator>(o));
    }
    std::printf("%3d %-30s %8llu pairs, caught by%s\n", mutant.number, mutant.name.c_str(),
                static_cast<unsigned long long>(run[0].pairs), caught_by.c_str());
    EXPECT_NE(caught_by, "") << mutant.name << ": " << mutant.fault;
  }
  EXPECT_GT(tried, 20u);
}

TEST(OperatorCosim, MismatchNamesOperandsAndBothResults) {
  const OperatorRun run = run_operator_cosim(*make_mutant_operators(6), 0, 1, true);
  const std::string text = run[static_cast<std::size_t>(Operator::kSubtract)].first_mismatch;
  EXPECT_NE(text.find("subtract\n  a        "), std::string::npos) << text;
  EXPECT_NE(text.find("expected " + describe_bits(0x00000000)), std::string::npos) << text;
  EXPECT_NE(text.find("RTL      " + describe_bits(0x80000000)), std::string::npos) << text;
}

TEST(OperatorStimuli, EveryAimReachesWhatItNames) {
  // Operands as fields; the aims are statistical, so a few thousand pairs must contain the case.
  Random random(named_seed("EveryAimReachesWhatItNames", 1));
  std::vector<OperandPair> pairs(4096);
  std::vector<OperatorResults> results(pairs.size());
  const auto count = [&](Aim aim, Operator op, auto&& wanted) {
    fill_pairs(aim, random, pairs);
    host_results(pairs, results);
    int found = 0;
    for (const OperatorResults& result : results)
      found += wanted(result.word[static_cast<int>(op)]);
    return found;
  };
  const auto smallest = [](std::uint32_t word) { return (word & ~kSignBit) == kSmallestNormal; };
  const auto infinite = [](std::uint32_t word) { return (word & ~kSignBit) == kExponentMask; };
  const auto zero = [](std::uint32_t word) { return (word & ~kSignBit) == 0; };
  EXPECT_GT(count(Aim::kTinyProducts, Operator::kMultiply, smallest), 0);
  EXPECT_GT(count(Aim::kTinyProducts, Operator::kMultiply, zero), 200);
  EXPECT_GT(count(Aim::kLargeProducts, Operator::kMultiply, infinite), 200);
  EXPECT_GT(count(Aim::kSquares, Operator::kSquare, infinite), 200);
  EXPECT_GT(count(Aim::kSquares, Operator::kSquare, zero), 200);
  EXPECT_GT(count(Aim::kSmallSums, Operator::kAdd, zero), 50);
  EXPECT_GT(count(Aim::kLargeSums, Operator::kAdd, infinite), 200);
  EXPECT_GT(count(Aim::kCancellation, Operator::kSubtract, zero), 20);
  // Each of the exact product's low bits alone, beside the half bit.
  std::set<int> lone, lone_of_square;
  fill_pairs(Aim::kLoneBits, random, pairs);
  const auto mantissa = [](std::uint32_t word) {
    return std::uint64_t{word & 0x7fffffu} | 0x800000u;
  };
  for (const OperandPair& pair : pairs) {
    const std::uint64_t product = mantissa(pair.a) * mantissa(pair.b);
    const int half = 22 + static_cast<int>(product >> 47);
    EXPECT_EQ(product >> half & 3, 1u);
    const std::uint64_t below = product & ((1ull << half) - 1);
    EXPECT_EQ(std::popcount(below), 1);
    (pair.a == pair.b ? lone_of_square : lone).insert(std::countr_zero(below));
  }
  EXPECT_EQ(lone.size(), 23u);
  EXPECT_EQ(lone_of_square.size(), 11u);  // even places, three and more below the half bit
}

}  // namespace
}  // namespace emax
