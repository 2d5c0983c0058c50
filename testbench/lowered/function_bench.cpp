#include "testbench/lowered/function_bench.h"

#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "sw_model/base/float_bits.h"
#include "testbench/stimuli/words.h"

namespace emax {
namespace {

struct BenchOptions {
  int samples = 20000;
  std::uint64_t seed = 1;
  int late = 0;
};

template <class Number>
Number number_of(const std::string& option, std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::invalid_argument(option + " needs a number, not '" + std::string(text) + "'");
  }
  return value;
}

BenchOptions options_of(int argc, char** argv) {
  BenchOptions options;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&] { return i + 1 < argc ? argv[++i] : ""; };
    if (option == "--samples") {
      options.samples = number_of<int>(option, value());
    } else if (option == "--seed") {
      options.seed = number_of<std::uint64_t>(option, value());
    } else if (option == "--late") {
      options.late = 1;
    } else {
      throw std::invalid_argument("'" + option +
                                  "' is not understood; there are --samples N, --seed N, --late");
    }
  }
  return options;
}

// Of four samples one has ordinary numbers alone, two have some words of other kinds, and one has
// words of any kind in every place.
std::vector<Word> drawn_words(Random& random, std::size_t count, int sample) {
  constexpr std::uint32_t kSpoiled[] = {0, 1, 4, 16};  // of 16 words
  std::vector<Word> words(count);
  for (Word& word : words) {
    word = random.below(16) < kSpoiled[sample % 4]
               ? any_word(random)
               : float_bits(static_cast<float>(random.uniform(-2, 2)));
  }
  return words;
}

std::string described(const BenchPort& port, Word word) {
  return port.is_condition() ? (word != 0 ? "true" : "false") : describe_bits(word);
}

class Bench {
 public:
  Bench(const FunctionBench& bench, const BenchOptions& options)
      : bench_(bench), options_(options) {
    Random random(named_seed(bench.name, options.seed));
    for (int i = 0; i < options.samples; ++i) {
      samples_.push_back(drawn_words(random, bench.inputs.size(), i));
      for (std::size_t k = 0; k < bench.inputs.size(); ++k) {
        if (bench.inputs[k].is_condition()) samples_.back()[k] &= 1u;
      }
    }
  }

  bool equal() {
    for (int cycle = 0; cycle < options_.samples + bench_.latency; ++cycle) {
      if (cycle < options_.samples) give(samples_[static_cast<std::size_t>(cycle)]);
      bench_.evaluate(false);
      const int sample = cycle - bench_.latency - options_.late;
      if (sample >= 0 && sample < options_.samples && !compared(static_cast<std::size_t>(sample))) {
        return false;
      }
      bench_.evaluate(true);
    }
    return true;
  }

 private:
  void give(const std::vector<Word>& words) {
    for (std::size_t i = 0; i < words.size(); ++i) bench_.inputs[i].set(words[i]);
  }

  bool compared(std::size_t sample) const {
    const std::vector<Word> expected = bench_.model(samples_[sample]);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const BenchPort& port = bench_.outputs[i];
      if (port.get() == expected[i]) continue;
      std::printf("%.*s: sample %zu of seed %llu, output %zu: %s, model %s\n",
                  static_cast<int>(bench_.name.size()), bench_.name.data(), sample,
                  static_cast<unsigned long long>(options_.seed), i,
                  described(port, port.get()).c_str(), described(port, expected[i]).c_str());
      for (std::size_t k = 0; k < bench_.inputs.size(); ++k) {
        std::printf("  input %zu: %s\n", k,
                    described(bench_.inputs[k], samples_[sample][k]).c_str());
      }
      return false;
    }
    return true;
  }

  const FunctionBench& bench_;
  const BenchOptions options_;
  std::vector<std::vector<Word>> samples_;
};

}  // namespace

int run_bench(const FunctionBench& bench, int argc, char** argv) {
  try {
    const BenchOptions options = options_of(argc, argv);
    if (!Bench(bench, options).equal()) return 1;
    std::printf("%.*s: %d samples of seed %llu, a result every cycle after %d cycles, all equal\n",
                static_cast<int>(bench.name.size()), bench.name.data(), options.samples,
                static_cast<unsigned long long>(options.seed), bench.latency);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(bench.name.size()), bench.name.data(),
                 error.what());
    return 2;
  }
}

}  // namespace emax
