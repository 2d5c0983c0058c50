// Patterns of a stream. In a cycle in which the stream is not willing, a driver idles (begins no
// new beat) and a receiver presses back (is not ready). A driver that shows a beat keeps showing it
// until the beat is taken.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "testbench/stimuli/random.h"

namespace emax {

enum class Pattern : std::uint8_t {
  kAlways,     // willing in every cycle
  kMostly,     // 7 of 8, at random
  kHalf,       // 1 of 2, at random
  kRarely,     // 1 of 8, at random
  kAlternate,  // every other cycle
  kBursts,     // 1 to 32 cycles willing, then 1 to 32 cycles not
  kStalls,     // mostly willing, now and then not for 150 to 400 cycles: longer than any pipeline
};
constexpr std::uint32_t kPatterns = 7;
constexpr std::array<std::string_view, kPatterns> kPatternNames = {
    "always", "mostly", "half", "rarely", "alternate", "bursts", "stalls"};
constexpr std::uint32_t kLongestStall = 400;  // cycles

inline std::string_view name_of(Pattern pattern) {
  return kPatternNames[static_cast<std::size_t>(pattern)];
}

inline Pattern pattern_named(std::string_view name) {
  for (std::uint32_t i = 0; i < kPatterns; ++i) {
    if (kPatternNames[i] == name) return static_cast<Pattern>(i);
  }
  throw std::invalid_argument("unknown pattern '" + std::string(name) + "'");
}

class PatternSource {
 public:
  PatternSource(Pattern pattern, std::uint64_t seed) : pattern_(pattern), random_(seed) {}

  // Whether the stream is willing in the next cycle.
  bool next() {
    switch (pattern_) {
      case Pattern::kAlways:
        return true;
      case Pattern::kMostly:
        return !random_.one_in(8);
      case Pattern::kHalf:
        return random_.one_in(2);
      case Pattern::kRarely:
        return random_.one_in(8);
      case Pattern::kAlternate:
        return willing_ = !willing_;
      case Pattern::kBursts:
        if (left_ == 0) {
          willing_ = !willing_;
          left_ = 1 + random_.below(32);
        }
        --left_;
        return willing_;
      case Pattern::kStalls:
        if (left_ == 0 && random_.one_in(200)) {
          left_ = 150 + random_.below(kLongestStall - 150);
        }
        if (left_ == 0) return !random_.one_in(16);
        --left_;
        return false;
    }
    return true;
  }

 private:
  Pattern pattern_;
  Random random_;
  bool willing_ = false;
  std::uint32_t left_ = 0;
};

}  // namespace emax
