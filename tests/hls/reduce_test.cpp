#include "hls/kernel/reduce.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sw_model/base/float_bits.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(Reduce, BitsOfNonNegativeValuesOrderLikeTheValues) {
  test::Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t a = random.below(kInfinityWord + 1), b = random.below(kInfinityWord + 1);
    ASSERT_EQ(a < b, bits_float(a) < bits_float(b)) << describe_bits(a) << "  " << describe_bits(b);
  }
}

TEST(Reduce, MinimumMeetsInfinityFirst) {
  EXPECT_EQ(minimum(kInfinityWord, to_word(1e30f)), to_word(1e30f));
  EXPECT_EQ(minimum(to_word(2.0f), to_word(3.0f)), to_word(2.0f));
  EXPECT_EQ(minimum(to_word(3.0f), to_word(2.0f)), to_word(2.0f));
}

TEST(Reduce, MaximumKeepsTheFirstOfEquals) {
  const std::vector<Word> stream = {5, 9, 2, 9, 9, 1};
  WorstPoint<Word> worst = {stream[0], 0};
  for (Word i = 1; i < stream.size(); ++i) worst = maximum(worst, WorstPoint<Word>{stream[i], i});
  EXPECT_EQ(worst.squared_distance, *std::max_element(stream.begin(), stream.end()));
  EXPECT_EQ(worst.index, 1u);
}

}  // namespace
}  // namespace emax
