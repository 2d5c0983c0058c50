// The testbench of a lowered function: the Verilated pipeline beside the function itself on the
// model's scalar. `--testbench` writes the main that calls it (hls/lowering/testbench_text.h).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "hls/kernel/binary.h"
#include "hls/kernel/fixed.h"
#include "hls/kernel/word.h"
#include "hls/lowering/designs.h"
#include "hls/lowering/fields.h"
#include "sw_model/model/flushed_float.h"

namespace emax {

// The bits of a value: a condition as 0 or 1, a number in the low bits.
using Bits = std::uint64_t;

// A port of a Verilated module, which has one of four sizes.
class BenchPort {
 public:
  BenchPort(std::uint8_t& port) : byte_(&port) {}    // NOLINT(google-explicit-constructor)
  BenchPort(std::uint16_t& port) : half_(&port) {}   // NOLINT(google-explicit-constructor)
  BenchPort(std::uint32_t& port) : word_(&port) {}   // NOLINT(google-explicit-constructor)
  BenchPort(std::uint64_t& port) : words_(&port) {}  // NOLINT(google-explicit-constructor)

  void set(Bits bits) const {
    if (byte_ != nullptr) *byte_ = static_cast<std::uint8_t>(bits);
    if (half_ != nullptr) *half_ = static_cast<std::uint16_t>(bits);
    if (word_ != nullptr) *word_ = static_cast<std::uint32_t>(bits);
    if (words_ != nullptr) *words_ = bits;
  }
  Bits get() const {
    return byte_ != nullptr   ? *byte_
           : half_ != nullptr ? *half_
           : word_ != nullptr ? *word_
                              : *words_;
  }

 private:
  std::uint8_t* byte_ = nullptr;
  std::uint16_t* half_ = nullptr;
  std::uint32_t* word_ = nullptr;
  std::uint64_t* words_ = nullptr;
};

// A function on bits: those of its results for those of its arguments, with the types of both.
struct FunctionModel {
  std::vector<ValueType> arguments, results;
  std::function<std::vector<Bits>(std::span<const Bits>)> call;
};

struct FunctionBench {
  std::string_view name;
  int latency;
  std::vector<BenchPort> inputs, outputs;
  FunctionModel model;
  std::function<void(bool clock)> evaluate;  // the module, with its clock at this level
  std::function<LoweredDesign()> lowered;    // the function, as the module was made of it
  // For each input, how many cycles after its sample's first ones it comes; empty: all at once.
  std::vector<int> cycles = {};
};

// Gives the pipeline a new sample in every cycle and compares every result with the model's.
// --samples N (20000), --seed N (1); --late compares a cycle too late, which has to fail. The exit
// code: 0 if all results are equal, 1 if one is not, 2 for arguments that are not understood.
// --coverage and --mutants say what the samples are worth instead (graph_checks.h).
int run_bench(const FunctionBench& bench, int argc, char** argv);

struct UnitPorts {
  BenchPort write_enable, write_slot, slot;
};

// The module `<name>_unit` with 16 slots for records.
struct UnitBench {
  std::string_view name;
  int latency, last_read;
  std::vector<std::size_t> record;         // places of the arguments that a record holds, in order
  std::vector<BenchPort> inputs, outputs;  // those of the other arguments, and of the results
  FunctionModel model;
  UnitPorts slots;
  std::function<void(const std::vector<Word>&)> write_record;  // the lowest bits in the first word
  std::function<void(bool clock)> evaluate;
};

// Writes records into slots, each as soon as the unit permits it, gives a slot and the other
// arguments in every cycle, and compares every result. --samples, --seed and the exit code as of
// run_bench; --late compares each result with the sample before its own, which has to fail.
int run_unit_bench(const UnitBench& bench, int argc, char** argv);

// A port of any width, given words of which the first is the lowest.
template <class Port>
void set_words(Port& port, const std::vector<Word>& words) {
  if constexpr (std::is_integral_v<Port>) {
    Bits bits = 0;
    for (std::size_t i = words.size(); i-- > 0;) bits = bits << 32 | words[i];
    port = static_cast<Port>(bits);
  } else {
    for (std::size_t i = 0; i < words.size(); ++i) port.at(i) = words[i];
  }
}

// The stream of records of a function that has one.
struct RecordPorts {
  BenchPort tvalid, tready;
  std::vector<std::size_t> arguments;  // their places; the inputs there belong to a record's beat
};

struct StreamPorts {
  BenchPort aresetn, s_axis_tvalid, s_axis_tready, s_axis_tlast;
  BenchPort m_axis_tvalid, m_axis_tready, m_axis_tlast;
};

// The module `<name>_stream`, with its arguments and results as ports beside the handshakes.
struct StreamBench {
  std::string_view name;
  std::vector<BenchPort> inputs, outputs;
  FunctionModel model;
  StreamPorts streams;
  std::function<void(bool clock)> evaluate;
  std::optional<RecordPorts> records = {};
};

// Drives the streams through idle cycles and back-pressure, in stretches with and without either,
// and compares every result and its tlast. Records have 1 to some dozens of samples. --samples,
// --seed and the exit code as of run_bench;
// --late compares each result with the sample before its own, which has to fail.
int run_stream_bench(const StreamBench& bench, int argc, char** argv);

inline void set_scalar(FlushedFloat& scalar, Bits bits) {
  scalar = FlushedFloat(to_float(static_cast<Word>(bits)));
}
inline void set_scalar(bool& condition, Bits bits) { condition = (bits & 1u) != 0; }
template <int kExponent, int kMantissa>
void set_scalar(Binary<kExponent, kMantissa>& number, Bits bits) {
  number = number.from_bits(bits);
}
template <int kWidth, int kFraction, Rounding kRounding, Overflow kOverflow>
void set_scalar(Fixed<kWidth, kFraction, kRounding, kOverflow>& number, Bits bits) {
  number = number.from_raw(static_cast<std::int64_t>(bits));
}

inline Bits bits_of_scalar(FlushedFloat scalar) { return to_word(scalar); }
inline Bits bits_of_scalar(bool condition) { return condition ? 1 : 0; }
template <int kExponent, int kMantissa>
Bits bits_of_scalar(const Binary<kExponent, kMantissa>& number) {
  return number.bits();
}
template <int kWidth, int kFraction, Rounding kRounding, Overflow kOverflow>
Bits bits_of_scalar(const Fixed<kWidth, kFraction, kRounding, kOverflow>& number) {
  return static_cast<Bits>(number.raw()) & ((Bits{1} << kWidth) - 1);
}

inline ValueType type_of_scalar(FlushedFloat /*scalar*/) { return ValueKind::kReal; }
inline ValueType type_of_scalar(bool /*condition*/) { return ValueKind::kCondition; }
template <int kExponent, int kMantissa>
ValueType type_of_scalar(const Binary<kExponent, kMantissa>& number) {
  return ValueType(number.format());
}
template <int kWidth, int kFraction, Rounding kRounding, Overflow kOverflow>
ValueType type_of_scalar(const Fixed<kWidth, kFraction, kRounding, kOverflow>& number) {
  return ValueType(number.format());
}

template <class Result, class... Arguments>
FunctionModel on_words(Result (*function)(Arguments...)) {
  FunctionModel model;
  const auto types = [](std::vector<ValueType>& into, const auto&... values) {
    for_each_leaf([&](const auto& scalar) { into.push_back(type_of_scalar(scalar)); }, values...);
  };
  const std::tuple<std::decay_t<Arguments>...> none{};
  std::apply([&](const auto&... each) { types(model.arguments, each...); }, none);
  types(model.results, std::decay_t<Result>{});
  model.call = [function](std::span<const Bits> bits) {
    std::tuple<std::decay_t<Arguments>...> arguments;
    std::size_t next = 0;
    std::apply(
        [&](auto&... each) {
          for_each_leaf([&](auto& scalar) { set_scalar(scalar, bits[next++]); }, each...);
        },
        arguments);
    const auto result = std::apply(function, arguments);
    std::vector<Bits> results;
    for_each_leaf([&](const auto& scalar) { results.push_back(bits_of_scalar(scalar)); }, result);
    return results;
  };
  return model;
}

}  // namespace emax
