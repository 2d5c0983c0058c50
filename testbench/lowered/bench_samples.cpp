#include "testbench/lowered/bench_samples.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "sw_model/base/float_bits.h"
#include "testbench/stimuli/words.h"

namespace emax {
namespace {

template <class Number>
Number number_of(const std::string& option, std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::invalid_argument(option + " needs a number, not '" + std::string(text) + "'");
  }
  return value;
}

// Of 16 words, how many are of any kind: of four samples one has ordinary numbers alone, two have
// some words of other kinds, and one has words of any kind in every place.
std::uint32_t spoiled_words(int sample) {
  constexpr std::uint32_t kSpoiled[] = {0, 1, 4, 16};
  return kSpoiled[sample % 4];
}

// Ordinary numbers are spread over the format and its middle, where results do not saturate; those
// of other kinds are at its ends or small.
Bits drawn_fixed(Random& random, const ValueType& type, bool ordinary) {
  const Bits mask = (Bits{1} << type.width) - 1;
  if (ordinary) {
    const std::int64_t number = fixed_wrapped(random.bits(), type.width);
    return static_cast<Bits>(number >> random.below(4)) & mask;
  }
  const Bits near = random.below(4);
  const Bits greatest = mask >> 1;
  switch (random.below(4)) {
    case 0:
      return greatest - std::min(near, greatest);
    case 1:
      return (greatest + 1 + near) & mask;
    case 2:
      return (near - 2) & mask;
    default:
      return static_cast<Bits>(static_cast<std::int64_t>(random.bits()) >> random.below(64)) & mask;
  }
}

// Ordinary numbers are of the size of one. The others are words at or beside the ends of the
// format's kinds of numbers, any words, or small.
Bits drawn_binary(Random& random, const BinaryFormat& format, bool ordinary) {
  if (ordinary) return binary_constant(random.uniform(-2, 2), format);
  const Bits sign = random.one_in(2) ? format.sign() : 0;
  const Bits kinds[] = {0, format.least_normal(), format.one(), format.infinity(), format.nan()};
  const Bits kind = kinds[random.below(5)];
  switch (random.below(4)) {
    case 0:
      return sign | ((kind + random.below(3) - 1) & (format.sign() - 1));
    case 1:
      return random.bits() & (2 * format.sign() - 1);
    default:
      return binary_constant(random.uniform(-1, 1), format);
  }
}

Bits drawn_bits(Random& random, const ValueType& type, bool ordinary) {
  if (type.kind == ValueKind::kReal && !type.is_binary32()) {
    return drawn_binary(random, type.binary(), ordinary);
  }
  switch (type.kind) {
    case ValueKind::kCondition:
      return random.below(2);
    case ValueKind::kFixed:
      return drawn_fixed(random, type, ordinary);
    default:
      return ordinary ? float_bits(static_cast<float>(random.uniform(-2, 2))) : any_word(random);
  }
}

std::string described(const ValueType& type, Bits bits) {
  if (type.kind == ValueKind::kCondition) return bits != 0 ? "true" : "false";
  char text[80];
  if (type.kind == ValueKind::kReal && !type.is_binary32()) {
    std::snprintf(text, sizeof text, "0x%0*llx = %.9g", (type.width + 3) / 4,
                  static_cast<unsigned long long>(bits), binary_value(bits, type.binary()));
    return text;
  }
  if (type.kind != ValueKind::kFixed) return describe_bits(static_cast<Word>(bits));
  const std::int64_t number = fixed_wrapped(bits, type.width);
  std::snprintf(text, sizeof text, "%lld/2^%d = %.12g", static_cast<long long>(number),
                type.fraction, std::ldexp(static_cast<double>(number), -type.fraction));
  return text;
}

BenchOptions bench_options(int argc, char** argv) {
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
    } else if (option == "--coverage") {
      options.check = BenchCheck::kCoverage;
    } else if (option == "--mutants") {
      options.check = BenchCheck::kMutants;
    } else {
      throw std::invalid_argument("'" + option +
                                  "' is not understood; there are --samples N, --seed N, --late, "
                                  "--coverage, --mutants");
    }
  }
  return options;
}

}  // namespace

int bench_exit_code(std::string_view name, int argc, char** argv,
                    const std::function<int(const BenchOptions&)>& run) {
  try {
    return run(bench_options(argc, argv));
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(name.size()), name.data(), error.what());
    return 2;
  }
}

int comparison_exit_code(
    std::string_view name, int argc, char** argv,
    const std::function<std::optional<std::string>(const BenchOptions&)>& compare) {
  return bench_exit_code(name, argc, argv, [&](const BenchOptions& options) {
    if (options.check != BenchCheck::kResults) {
      throw std::invalid_argument("only the bench of the function has --coverage and --mutants");
    }
    const std::optional<std::string> results = compare(options);
    if (!results) return 1;
    std::printf("%.*s: %s, all equal\n", static_cast<int>(name.size()), name.data(),
                results->c_str());
    return 0;
  });
}

std::vector<std::vector<Bits>> drawn_samples(std::string_view name, const FunctionModel& model,
                                             const BenchOptions& options) {
  Random random(named_seed(name, options.seed));
  std::vector<std::vector<Bits>> samples;
  for (int i = 0; i < options.samples; ++i) {
    std::vector<Bits> sample;
    for (const ValueType& type : model.arguments) {
      const bool ordinary = random.below(16) >= spoiled_words(i);
      sample.push_back(drawn_bits(random, type, ordinary));
    }
    samples.push_back(std::move(sample));
  }
  return samples;
}

bool is_models_result(std::string_view name, const FunctionModel& model,
                      const std::vector<BenchPort>& outputs, const std::vector<Bits>& sample,
                      std::size_t number, std::uint64_t seed) {
  const std::vector<Bits> expected = model.call(sample);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Bits given = outputs[i].get();
    if (given == expected[i]) continue;
    std::printf("%.*s: sample %zu of seed %llu, output %zu: %s, model %s\n",
                static_cast<int>(name.size()), name.data(), number,
                static_cast<unsigned long long>(seed), i,
                described(model.results[i], given).c_str(),
                described(model.results[i], expected[i]).c_str());
    for (std::size_t k = 0; k < sample.size(); ++k) {
      std::printf("  input %zu: %s\n", k, described(model.arguments[k], sample[k]).c_str());
    }
    return false;
  }
  return true;
}

}  // namespace emax
