#pragma once

#include <cstdint>
#include <span>

#include "testbench/operators/operator_unit.h"

namespace emax {

// The results of this processor's own binary32 arithmetic with subnormals flushed and each NaN as
// 0x7fc00000. Sets the flush mode while it runs.
void host_results(std::span<const OperandPair> pairs, std::span<OperatorResults> results);

// A format of 1 + exponent + fraction bits, at most 32 in all with at most 10 of exponent, under
// the rules of docs/numerics.md. `rounded` rounds an exact result once. `results` computes in
// double (which must not flush), which is exact in formats of at most 8 bits: there the processor
// rounds nothing. No code or method is shared with the RTL.
struct SmallFormat {
  int exponent, fraction;

  int width() const { return 1 + exponent + fraction; }
  double value(std::uint32_t word) const;
  std::uint32_t rounded(double exact) const;
  OperatorResults results(OperandPair pair) const;
};

}  // namespace emax
