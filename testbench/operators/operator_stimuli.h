#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "testbench/operators/operator_unit.h"
#include "testbench/stimuli/random.h"

namespace emax {

// What operand pairs aim at. Every operator meets all of them.
enum class Aim {
  kAnyBits,          // two random words
  kNearExponents,    // exponents at most 30 apart
  kCancellation,     // magnitudes a few units in the last place apart
  kSmallSums,        // sums and differences about the smallest normal number
  kLargeSums,        // and about the largest
  kTinyProducts,     // products about the smallest normal number
  kLargeProducts,    // and about the largest
  kSquares,          // a with its square about either
  kSparseFractions,  // fractions of few ones or few zeros: ties, carries, long runs
  kTies,             // sums half a unit in the last place, or nearly, from a number
  kLoneBits,         // products and squares whose rounding a single bit far below decides
};
constexpr int kAims = 11;
const char* aim_name(Aim aim);

// Fills `pairs` with binary32 pairs of that aim.
void fill_pairs(Aim aim, Random& random, std::span<OperandPair> pairs);

// Signed zeros, subnormals, the ends of the normal range, one and its neighbours, powers of two
// that make ties, infinities, quiet and signalling NaNs; every pair of them.
std::vector<std::uint32_t> corner_words();
std::vector<OperandPair> corner_pairs();

}  // namespace emax
