#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace emax {

// A pair of operands and the results of all operators. Formats narrower than 32 bits use the low
// bits of a word; a comparison gives 0 or 1.
struct OperandPair {
  std::uint32_t a, b;
};

enum class Operator { kAdd, kSubtract, kMultiply, kSquare, kLess };
constexpr int kOperators = 5;

struct OperatorResults {
  std::uint32_t word[kOperators];
};

// Operators that take a pair in every cycle, without gaps, and give results in order.
class OperatorUnit {
 public:
  virtual ~OperatorUnit() = default;
  // results[i] belongs to pairs[i]; throws Error when the unit gives another number of results.
  virtual void run(std::span<const OperandPair> pairs, std::span<OperatorResults> results) = 0;
  virtual std::uint64_t cycles() const = 0;  // since the unit was made
  // Writes the coverage for verilator_coverage; throws Error in a build that counts none.
  virtual void write_coverage(const std::string& path) = 0;
};

// The Verilated operators with the latencies of the datapath: binary32 and two formats of 8 bits
// (exponent + fraction).
std::unique_ptr<OperatorUnit> make_operators_8_23();
std::unique_ptr<OperatorUnit> make_operators_4_3();
std::unique_ptr<OperatorUnit> make_operators_5_2();

// The binary32 operators with this mutant of hls/rtl/mutation.sv active; 0 is the unchanged design.
// In the library emax_mutant_operators.
std::unique_ptr<OperatorUnit> make_mutant_operators(int mutant);

// The binary32 operators with counters of coverage. In the library emax_covered_operators.
std::unique_ptr<OperatorUnit> make_covered_operators();

}  // namespace emax
