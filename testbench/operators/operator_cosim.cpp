#include "testbench/operators/operator_cosim.h"

#include <algorithm>
#include <array>

#include "sw_model/base/float_bits.h"
#include "testbench/operators/operator_stimuli.h"
#include "testbench/operators/operator_tests.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr std::array<const char*, kOperators> kNames = {"add", "subtract", "multiply", "square",
                                                        "less"};
constexpr std::size_t kBatch = 4096;

bool gives_float(Operator op) { return op <= Operator::kSquare; }
bool takes_two(Operator op) { return op <= Operator::kMultiply || op == Operator::kLess; }

using Describe = std::function<std::string(std::uint32_t)>;

std::string describe_small(SmallFormat format, std::uint32_t word) {
  std::string text;
  for (int bit = format.width() - 1; bit >= 0; --bit) {
    text += (word >> bit & 1u) != 0 ? '1' : '0';
    if (bit == format.width() - 1 || bit == format.fraction) text += '/';
  }
  return text + " = " + std::to_string(format.value(word));
}

std::string mismatch_text(Operator op, OperandPair pair, std::uint32_t expected,
                          std::uint32_t actual, const Describe& describe) {
  const auto result = [&](std::uint32_t word) {
    return gives_float(op) ? describe(word) : std::to_string(word);
  };
  std::string text = std::string(operator_name(op)) + "\n  a        " + describe(pair.a);
  if (takes_two(op)) text += "\n  b        " + describe(pair.b);
  return text + "\n  expected " + result(expected) + "\n  RTL      " + result(actual);
}

bool compare(std::span<const OperandPair> pairs, std::span<const OperatorResults> expected,
             std::span<const OperatorResults> actual, const Describe& describe, OperatorRun& run) {
  bool agree = true;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (std::equal(std::begin(expected[i].word), std::end(expected[i].word),
                   std::begin(actual[i].word)))
      continue;
    agree = false;
    for (std::size_t o = 0; o < kOperators; ++o) {
      const std::uint32_t right = expected[i].word[o], given = actual[i].word[o];
      if (right == given) continue;
      if (run[o].mismatches++ == 0) {
        run[o].first_mismatch =
            mismatch_text(static_cast<Operator>(o), pairs[i], right, given, describe);
      }
    }
  }
  for (OperatorResult& result : run) result.pairs += pairs.size();
  return agree;
}

}  // namespace

const char* operator_name(Operator op) { return kNames[static_cast<std::size_t>(op)]; }

OperatorRun run_operator_cosim(OperatorUnit& unit, std::uint64_t pairs, std::uint64_t seed,
                               bool stop_at_mismatch, const OperatorWatch& watch) {
  OperatorRun run(kOperators);
  std::vector<OperatorResults> expected(kBatch), actual(kBatch);
  const auto agree = [&](std::span<const OperandPair> batch) {
    const std::span<OperatorResults> right(expected.data(), batch.size());
    const std::span<OperatorResults> given(actual.data(), batch.size());
    host_results(batch, right);
    unit.run(batch, given);
    return compare(batch, right, given, describe_bits, run);
  };
  const std::vector<OperandPair> corners = corner_pairs();
  for (std::size_t i = 0; i < corners.size(); i += kBatch) {
    const std::size_t count = std::min(kBatch, corners.size() - i);
    if (!agree({corners.data() + i, count}) && stop_at_mismatch) return run;
  }
  Random random(seed);
  std::vector<OperandPair> batch(kBatch);
  for (std::uint64_t done = 0, number = 0; done < pairs; done += batch.size(), ++number) {
    batch.resize(std::min<std::uint64_t>(kBatch, pairs - done));
    fill_pairs(static_cast<Aim>(number % kAims), random, batch);
    if (!agree(batch) && stop_at_mismatch) return run;
    if (watch && !watch(static_cast<double>(done) / static_cast<double>(pairs))) break;
  }
  return run;
}

OperatorTest binary32_test(std::function<std::unique_ptr<OperatorUnit>()> make_unit,
                           std::uint64_t pairs) {
  return {"operators: binary32", std::move(make_unit),
          [pairs](OperatorUnit& unit, std::uint64_t seed, const OperatorWatch& watch) {
            return run_operator_cosim(unit, pairs, seed, false, watch);
          }};
}

OperatorRun run_small_cosim(OperatorUnit& unit, SmallFormat format) {
  OperatorRun run(kOperators);
  const std::uint32_t words = 1u << format.width();
  std::vector<OperandPair> pairs(words);
  std::vector<OperatorResults> expected(words), actual(words);
  for (std::uint32_t a = 0; a < words; ++a) {
    for (std::uint32_t b = 0; b < words; ++b) {
      pairs[b] = {a, b};
      expected[b] = format.results(pairs[b]);
    }
    unit.run(pairs, actual);
    compare(
        pairs, expected, actual,
        [format](std::uint32_t word) { return describe_small(format, word); }, run);
  }
  return run;
}

}  // namespace emax
