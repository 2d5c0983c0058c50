// The testbench of a lowered function: the Verilated pipeline beside the function itself on the
// model's scalar. `--testbench` writes the main that calls it (hls/lowering/testbench_text.h).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "hls/kernel/word.h"
#include "hls/lowering/fields.h"
#include "sw_model/model/flushed_float.h"

namespace emax {

// A port of a Verilated module: 32 bits, or one.
class BenchPort {
 public:
  BenchPort(std::uint32_t& word) : word_(&word) {}          // NOLINT(google-explicit-constructor)
  BenchPort(std::uint8_t& condition) : bit_(&condition) {}  // NOLINT(google-explicit-constructor)

  bool is_condition() const { return bit_ != nullptr; }
  void set(Word word) const {
    if (word_ != nullptr) *word_ = word;
    if (bit_ != nullptr) *bit_ = (word & 1u) != 0;
  }
  Word get() const { return word_ != nullptr ? *word_ : *bit_; }

 private:
  std::uint32_t* word_ = nullptr;
  std::uint8_t* bit_ = nullptr;
};

// The words of a function's results for those of its arguments.
using WordFunction = std::function<std::vector<Word>(std::span<const Word>)>;

struct FunctionBench {
  std::string_view name;
  int latency;
  std::vector<BenchPort> inputs, outputs;
  WordFunction model;
  std::function<void(bool clock)> evaluate;  // the module, with its clock at this level
};

// Gives the pipeline a new sample in every cycle and compares every result with the model's.
// --samples N (20000), --seed N (1); --late compares a cycle too late, which has to fail. The exit
// code: 0 if all results are equal, 1 if one is not, 2 for arguments that are not understood.
int run_bench(const FunctionBench& bench, int argc, char** argv);

inline void set_scalar(FlushedFloat& scalar, Word word) { scalar = FlushedFloat(to_float(word)); }
inline void set_scalar(bool& condition, Word word) { condition = (word & 1u) != 0; }
inline Word word_of_scalar(FlushedFloat scalar) { return to_word(scalar); }
inline Word word_of_scalar(bool condition) { return condition ? 1 : 0; }

template <class Result, class... Arguments>
WordFunction on_words(Result (*function)(Arguments...)) {
  return [function](std::span<const Word> words) {
    std::tuple<std::decay_t<Arguments>...> arguments;
    std::size_t next = 0;
    std::apply(
        [&](auto&... each) {
          for_each_leaf([&](auto& scalar) { set_scalar(scalar, words[next++]); }, each...);
        },
        arguments);
    const auto result = std::apply(function, arguments);
    std::vector<Word> results;
    for_each_leaf([&](const auto& scalar) { results.push_back(word_of_scalar(scalar)); }, result);
    return results;
  };
}

}  // namespace emax
