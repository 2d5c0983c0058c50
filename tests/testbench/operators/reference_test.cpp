#include <gtest/gtest.h>

#include <cmath>

#include "sw_model/base/float_bits.h"
#include "sw_model/model/flushed_float.h"
#include "testbench/operators/operator_reference.h"
#include "testbench/operators/operator_stimuli.h"

namespace emax {
namespace {

// Values of a format in order, by brute force over its words.
std::uint32_t nearest_by_search(SmallFormat format, double exact) {
  const std::uint32_t infinity = ((1u << format.exponent) - 1) << format.fraction;
  std::uint32_t best = 1u << format.fraction;  // the smallest normal number
  for (std::uint32_t word = best; word < infinity; ++word) {
    const double distance = std::fabs(format.value(word) - exact);
    const double least = std::fabs(format.value(best) - exact);
    if (distance < least || (distance == least && (word & 1u) == 0)) best = word;
  }
  return best;
}

TEST(SmallFormat, RoundsToTheNearestOfAllValues) {
  for (const SmallFormat format : {SmallFormat{4, 3}, SmallFormat{5, 2}}) {
    const double smallest = format.value(1u << format.fraction);
    const double largest = format.value((((1u << format.exponent) - 1) << format.fraction) - 1);
    for (double exact = smallest; exact < largest; exact *= 1 + 0x1p-7) {
      const double sixteenth = std::ldexp(std::round(std::ldexp(exact, 12)), -12);
      for (const double value : {exact, std::clamp(sixteenth, smallest, largest)}) {
        ASSERT_EQ(format.rounded(value), nearest_by_search(format, value)) << value;
      }
    }
  }
}

TEST(SmallFormat, EdgesOfTheRange) {
  const SmallFormat format{4, 3};  // bias 7, normal from 2^-6 to 240
  EXPECT_EQ(format.value(0x08), 0x1p-6);
  EXPECT_EQ(format.value(0x77), 240.0);
  EXPECT_EQ(format.value(0x01), 0.0);  // subnormal
  EXPECT_EQ(format.rounded(0x1p-6 * (1 - 0x1p-5)), 0x08u);
  EXPECT_EQ(format.rounded(0x1p-6 * (1 - 0x1p-5) - 0x1p-30), 0x00u);
  EXPECT_EQ(format.rounded(-0x1p-9), 0x80u);
  EXPECT_EQ(format.rounded(248.0 - 0x1p-20), 0x77u);
  EXPECT_EQ(format.rounded(248.0), 0x78u);  // the tie goes to even: infinity
  EXPECT_EQ(format.rounded(-1e9), 0xf8u);
  EXPECT_EQ(format.rounded(std::nan("")), 0x7cu);
}

TEST(HostResults, AreTheModelScalarsOnCorners) {
  const std::vector<OperandPair> pairs = corner_pairs();
  std::vector<OperatorResults> results(pairs.size());
  host_results(pairs, results);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const FlushedFloat a(bits_float(pairs[i].a)), b(bits_float(pairs[i].b));
    const OperatorResults model = {
        {to_word(a + b), to_word(a - b), to_word(a * b), to_word(a * a), a < b}};
    for (int o = 0; o < kOperators; ++o) {
      ASSERT_EQ(results[i].word[o], model.word[o])
          << describe_bits(pairs[i].a) << ", " << describe_bits(pairs[i].b) << ", operator " << o;
    }
  }
}

}  // namespace
}  // namespace emax
