#include "sw_model/model/flushed_float.h"

#include <gtest/gtest.h>

#include <vector>

#include "sw_model/base/flush_mode.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

[[gnu::noinline]] float native(char operation, float a, float b) {
  const ScopedFlushMode flush;
  volatile float x = a, y = b;
  return operation == '+' ? x + y : operation == '-' ? x - y : x * y;
}

std::uint32_t modelled(char operation, float a, float b) {
  const FlushedFloat x(a), y(b);
  return to_word(operation == '+' ? x + y : operation == '-' ? x - y : x * y);
}

// The processor's own NaN differs from the contract's in its bits.
std::uint32_t canonical(float value) {
  const std::uint32_t bits = float_bits(value);
  return is_nan_bits(bits) ? kCanonicalNan : bits;
}

void expect_equal(char operation, float a, float b) {
  ASSERT_EQ(modelled(operation, a, b), canonical(native(operation, a, b)))
      << describe_bits(float_bits(a)) << "  " << operation << "  " << describe_bits(float_bits(b));
}

const std::vector<std::uint32_t> kCorners = {
    0x00000000, 0x00000001, 0x00400000, 0x007fffff, 0x00800000, 0x00800001, 0x00ffffff, 0x01000000,
    0x33800000, 0x3f000000, 0x3f7fffff, 0x3f800000, 0x3f800001, 0x3fffffff, 0x40000000, 0x4b800000,
    0x7e800000, 0x7f000000, 0x7f7fffff, 0x7f800000, 0x7f800001, 0x7fc00000, 0x1fffffff, 0x20000000};

TEST(FlushedFloat, EqualsTheProcessorOnAllPairsOfCorners) {
  for (const std::uint32_t a : kCorners) {
    for (const std::uint32_t b : kCorners) {
      for (const std::uint32_t signs : {0u, 1u, 2u, 3u}) {
        const float x = bits_float(a | (signs & 1u) << 31), y = bits_float(b | (signs >> 1) << 31);
        for (const char operation : {'+', '-', '*'}) expect_equal(operation, x, y);
      }
    }
  }
}

TEST(FlushedFloat, EqualsTheProcessorOnRandomPairs) {
  test::Random random(5);
  for (int i = 0; i < 300000; ++i) {
    const auto a = static_cast<std::uint32_t>(random.bits());
    auto b = static_cast<std::uint32_t>(random.bits());
    if (i % 3 == 1) b = (b & ~kExponentMask) | (a & kExponentMask);  // near exponents: cancellation
    // Exponents that add up to the edge of the subnormals: products around the flush threshold.
    if (i % 3 == 2)
      b = (b & ~kExponentMask) | ((0x40000000u - (a & kExponentMask)) & kExponentMask);
    for (const char operation : {'+', '-', '*'}) {
      expect_equal(operation, bits_float(a), bits_float(b));
    }
  }
}

TEST(FlushedFloat, FlushesWhatIsTinyAfterRoundingAtUnboundedExponent) {
  EXPECT_EQ(modelled('*', bits_float(0x3f7fffff), bits_float(0x00800000)), 0u);
  EXPECT_EQ(modelled('*', bits_float(0xbf7fffff), bits_float(0x00800000)), kSignBit);
  // Exactly half a step below the smallest normal rounds to it (even) and stays.
  EXPECT_EQ(modelled('*', 0x1.000002p-63f, 0x1.fffffcp-64f), kSmallestNormal);
}

TEST(FlushedFloat, ComparesSubnormalsAsZero) {
  EXPECT_FALSE(FlushedFloat(bits_float(0x80000001)) < FlushedFloat(0.0f));
  EXPECT_FALSE(FlushedFloat(-0.0f) < FlushedFloat(0.0f));
  EXPECT_TRUE(FlushedFloat(-0x1p-126f) < FlushedFloat(0.0f));
}

// The fault this file must catch: plain binary32, which keeps subnormals.
TEST(FlushedFloat, DiffersFromUnflushedArithmetic) {
  volatile float a = 0x1p-100f, b = 0x1p-40f;
  EXPECT_NE(float_bits(a * b), modelled('*', a, b));
}

}  // namespace
}  // namespace emax
