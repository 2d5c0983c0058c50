// 32-bit words, and binary32 values as words.
#pragma once

#include <cstdint>

namespace emax {

using Word = std::uint32_t;

static_assert(sizeof(float) == sizeof(Word), "the kernel's scalar is binary32");

union FloatWord {
  float value;
  Word word;
};

inline Word to_word(float value) {
  FloatWord both;
  both.value = value;
  return both.word;
}

inline float to_float(Word word) {
  FloatWord both;
  both.word = word;
  return both.value;
}

}  // namespace emax
