#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "testbench/operators/operator_unit.h"
#include "testbench/stimuli/random.h"

namespace emax {

// The aims of operand pairs. Every operator meets pairs of all aims.
enum class Aim {
  kAnyBits,          // two random words
  kNearExponents,    // exponents at most 30 apart
  kCancellation,     // magnitudes a few units in the last place apart
  kSmallSums,        // sums and differences near the smallest normal number
  kLargeSums,        // sums and differences near the largest number
  kTinyProducts,     // products near the smallest normal number
  kLargeProducts,    // products near the largest number
  kSquares,          // a whose square is near the smallest normal or the largest number
  kSparseFractions,  // fractions of few ones or few zeros: ties, carries, long runs
  kTies,             // sums half a unit in the last place, or nearly, from a number
  kLoneBits,         // products and squares whose rounding a single bit far below decides
};
constexpr int kAims = 11;
const char* aim_name(Aim aim);

// Fills `pairs` with binary32 pairs of that aim.
void fill_pairs(Aim aim, Random& random, std::span<OperandPair> pairs);

// Every pair of these: signed zeros, subnormals, the ends of the normal range, one and its
// neighbours, powers of two that make ties, infinities, quiet and signalling NaNs.
std::vector<std::uint32_t> corner_words();
std::vector<OperandPair> corner_pairs();

}  // namespace emax
