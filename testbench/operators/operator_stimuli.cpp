#include "testbench/operators/operator_stimuli.h"

#include <algorithm>

#include "sw_model/base/float_bits.h"

namespace emax {
namespace {

constexpr int kInfiniteExponent = 255;

std::uint32_t compose(std::uint32_t sign, int exponent, std::uint32_t fraction) {
  const auto held = static_cast<std::uint32_t>(std::clamp(exponent, 0, kInfiniteExponent));
  return (sign & 1u) << 31 | held << 23 | (fraction & kFractionMask);
}

// A few ones among zeros or the reverse, at random places or in one run.
std::uint32_t sparse_fraction(Random& random) {
  const std::uint64_t bits = random.bits();
  const auto place = [bits](int shift) { return 1u << ((bits >> shift & 31) % 23); };
  std::uint32_t fraction = 0;
  switch (bits & 3) {
    case 0:
      fraction = place(8);
      break;
    case 1:
      fraction = place(8) | place(13) | place(18);
      break;
    case 2:
      fraction = place(8) - place(13);
      break;
    default:
      fraction = static_cast<std::uint32_t>(bits >> 40) & 3u;
      break;
  }
  return ((bits & 4) != 0 ? ~fraction : fraction) & kFractionMask;
}

OperandPair any_pair(Random& random) {
  const std::uint64_t bits = random.bits();
  return {static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits)};
}

int exponent_of(std::uint32_t word) { return static_cast<int>(word >> 23 & 255u); }

int around(Random& random, int middle, int reach) {
  return middle - reach + static_cast<int>(random.below(2 * static_cast<std::size_t>(reach) + 1));
}

// A pair whose exponents add up to about `sum`; half of the pairs have a product near a power of
// two.
OperandPair product_pair(Random& random, int sum) {
  OperandPair pair = any_pair(random);
  if (random.one_in(2)) pair.a = (pair.a & ~kFractionMask) | sparse_fraction(random);
  if (random.one_in(4)) pair.b = (pair.b & ~kFractionMask) | sparse_fraction(random);
  if (random.one_in(2)) {
    const std::uint64_t reciprocal = (1ull << 47) / (1u << 23 | (pair.a & kFractionMask));
    const std::uint32_t near =
        static_cast<std::uint32_t>(around(random, 0, 2)) + static_cast<std::uint32_t>(reciprocal);
    pair.b = (pair.b & kSignBit) | (near & kFractionMask);
  }
  pair.b = compose(pair.b >> 31, around(random, sum, 2) - exponent_of(pair.a), pair.b);
  return pair;
}

// The inverse of an odd `a` modulo 2^64, by Newton's iteration; each step doubles the correct bits.
std::uint64_t inverse(std::uint64_t a) {
  std::uint64_t x = a;
  for (int i = 0; i < 5; ++i) x *= 2 - a * x;
  return x;
}

// A square root of c modulo 2^bits; c is 1 modulo 8.
std::uint64_t square_root(std::uint64_t c, int bits) {
  std::uint64_t root = 1;
  for (int bit = 3; bit < bits; ++bit) {
    if (((root * root ^ c) >> bit & 1) != 0) root += 1ull << (bit - 1);
  }
  return root;
}

constexpr std::uint64_t kHidden = 1u << 23;  // of a mantissa

bool is_mantissa(std::uint64_t m) { return m >= kHidden && m < 2 * kHidden; }

// Mantissas whose product differs from an even number by half a unit in the last place and one bit
// far below: that bit alone decides the rounding.
OperandPair lone_bit_product(Random& random, bool square) {
  while (true) {
    // 1 where the product of the mantissas is to be 2 or more.
    const int shift = random.one_in(2) ? 1 : 0;
    const int half = 22 + shift,
              lone = static_cast<int>(random.below(static_cast<std::size_t>(half)));
    std::uint64_t a = kHidden | (random.bits() & kFractionMask) | 1, b = 0;
    if (!square) {
      b = (1ull << half | 1ull << lone) * inverse(a) & ((1ull << (half + 2)) - 1);
    } else if (lone % 2 == 0 && half - lone >= 3) {
      // The square is (2^m u)^2 with u odd, so its lowest bit is at an even place.
      const int m = lone / 2, bits = half + 2 - lone;
      const std::uint64_t u = square_root(1 | 1ull << (half - lone), bits);
      a = b = ((random.bits() << (bits - 1)) + u) << m & (2 * kHidden - 1);
    }
    if (is_mantissa(a) && is_mantissa(b) && (a * b >> 47) == static_cast<unsigned>(shift)) {
      return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)};
    }
  }
}

OperandPair pair_of(Aim aim, Random& random) {
  OperandPair pair = any_pair(random);
  switch (aim) {
    case Aim::kAnyBits:
      break;
    case Aim::kNearExponents:
      pair.b = compose(pair.b >> 31, around(random, exponent_of(pair.a), 30), pair.b);
      break;
    case Aim::kCancellation: {
      const std::uint32_t near = pair.a + static_cast<std::uint32_t>(around(random, 0, 40));
      pair.b = random.one_in(4) ? compose(pair.b >> 31, around(random, exponent_of(pair.a), 1),
                                          random.one_in(2) ? pair.b : sparse_fraction(random))
                                : near ^ (pair.b & kSignBit);
      break;
    }
    case Aim::kSmallSums:
      pair.a = compose(pair.a >> 31, static_cast<int>(random.below(26)), pair.a);
      pair.b = compose(pair.b >> 31, around(random, exponent_of(pair.a), 2), pair.b);
      break;
    case Aim::kLargeSums:
      pair.a = compose(pair.a >> 31, 255 - static_cast<int>(random.below(4)), pair.a);
      if (random.one_in(2)) pair.a |= kFractionMask & ~3u;
      pair.b = compose(pair.b >> 31, 255 - static_cast<int>(random.below(30)), pair.b);
      break;
    case Aim::kTinyProducts:
      pair = product_pair(random, 127);
      break;
    case Aim::kLargeProducts:
      pair = product_pair(random, 381);
      break;
    case Aim::kSquares: {
      // The square roots of the ends of the range are near 2^-63 and 2^64.
      static constexpr std::uint32_t kRoots[] = {0x1fffffffu, 0x20000000u, 0x5f7fffffu,
                                                 0x5f800000u};
      pair.a = (pair.a & kSignBit) |
               (kRoots[random.below(4)] + static_cast<std::uint32_t>(around(random, 0, 2000)));
      if (random.one_in(2)) pair.b = pair.a;
      break;
    }
    case Aim::kSparseFractions:
      pair.a = compose(pair.a >> 31, exponent_of(pair.a), sparse_fraction(random));
      pair.b =
          compose(pair.b >> 31, around(random, exponent_of(pair.a), 27), sparse_fraction(random));
      break;
    case Aim::kTies: {
      const int below = 22 + static_cast<int>(random.below(5));
      const std::uint32_t tail = random.one_in(2) ? 0 : sparse_fraction(random);
      pair.b = compose(pair.b >> 31, exponent_of(pair.a) - below, tail);
      break;
    }
    case Aim::kLoneBits: {
      const OperandPair mantissas = lone_bit_product(random, random.one_in(2));
      const int exponent = 70 + static_cast<int>(random.below(100));
      pair = {compose(pair.a >> 31, exponent, mantissas.a),
              compose(pair.b >> 31, exponent, mantissas.b)};
      break;
    }
  }
  return random.one_in(2) ? pair : OperandPair{pair.b, pair.a};
}

}  // namespace

const char* aim_name(Aim aim) {
  static constexpr const char* kNames[kAims] = {
      "any bits",         "near exponents", "cancellation",   "small sums",
      "large sums",       "tiny products",  "large products", "squares",
      "sparse fractions", "ties",           "lone bits"};
  return kNames[static_cast<int>(aim)];
}

void fill_pairs(Aim aim, Random& random, std::span<OperandPair> pairs) {
  for (OperandPair& pair : pairs) pair = pair_of(aim, random);
}

std::vector<std::uint32_t> corner_words() {
  const std::vector<std::uint32_t> magnitudes = {
      0x00000000, 0x00000001, 0x00400000, 0x007fffff,              // zero, subnormals
      0x00800000, 0x00800001, 0x00ffffff, 0x01000000, 0x0c000000,  // smallest normals and 2^-103
      0x1fb504f3, 0x20000000, 0x33000000, 0x33800000, 0x33800001,  // 2^-63.5, 2^-63, 2^-25, 2^-24
      0x34000000, 0x3effffff, 0x3f000000, 0x3f7fffff, 0x3f800000,  // 2^-23, about 1/2 and 1
      0x3f800001, 0x3fffffff, 0x40000000, 0x4b000000, 0x4b7fffff,  // about 2, 2^23, 2^24
      0x4b800000, 0x5f7fffff, 0x5f800000, 0x72ffffff, 0x73000000,  // about 2^64, 2^103 (half an ulp
      0x7effffff, 0x7f000000, 0x7f7ffffe, 0x7f7fffff,              // of the largest), the largest
      0x7f800000, 0x7f800001, 0x7fbfffff, 0x7fc00000, 0x7fffffff   // infinity, NaNs
  };
  std::vector<std::uint32_t> words = magnitudes;
  for (const std::uint32_t magnitude : magnitudes) words.push_back(magnitude | kSignBit);
  return words;
}

std::vector<OperandPair> corner_pairs() {
  const std::vector<std::uint32_t> words = corner_words();
  std::vector<OperandPair> pairs;
  pairs.reserve(words.size() * words.size());
  for (const std::uint32_t a : words)
    for (const std::uint32_t b : words) pairs.push_back({a, b});
  return pairs;
}

}  // namespace emax
