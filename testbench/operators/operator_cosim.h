#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "testbench/operators/operator_reference.h"
#include "testbench/operators/operator_unit.h"

namespace emax {

// "add", "subtract", "multiply", "square", "less" (a < b).
const char* operator_name(Operator op);

struct OperatorResult {
  std::uint64_t pairs = 0;
  std::uint64_t mismatches = 0;
  std::string first_mismatch;  // operands and both results as sign/exponent/fraction; empty if none
};

// The comparison of one run: all operators, indexed by Operator.
using OperatorRun = std::vector<OperatorResult>;

// Called after each batch with the share that is done; false ends the run.
using OperatorWatch = std::function<bool(double share)>;

// Drives `unit` (binary32) with every corner pair, then `pairs` pairs over all aims, beside the
// processor's own arithmetic. With stop_at_mismatch it ends after the first batch that has one.
OperatorRun run_operator_cosim(OperatorUnit& unit, std::uint64_t pairs, std::uint64_t seed,
                               bool stop_at_mismatch = false, const OperatorWatch& watch = {});

// Drives `unit` beside SmallFormat with every pair of a format of 8 bits.
OperatorRun run_small_cosim(OperatorUnit& unit, SmallFormat format);

}  // namespace emax
