// Drives the operators' netlist beside the processor's own arithmetic, with the stimuli of the
// source's co-simulation.
//
//   netlist_operators [PAIRS]
//
// Prints the first mismatch of each operator. Exit code 0 without a mismatch, else 1.
#include <Vnetlist_operators.h>

#include <cstdio>
#include <cstdlib>

#include "testbench/operators/operator_cosim.h"
#include "testbench/operators/verilated_operators.h"
#include "testbench/stimuli/random.h"

int main(int argc, char** argv) {
  const std::uint64_t pairs = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 300'000;
  emax::VerilatedOperators<Vnetlist_operators> unit;
  const emax::OperatorRun run =
      emax::run_operator_cosim(unit, pairs, emax::named_seed("netlist_operators", 1));
  std::uint64_t compared = 0, mismatches = 0;
  for (const emax::OperatorResult& result : run) {
    compared += result.pairs;
    mismatches += result.mismatches;
    if (result.mismatches != 0) std::printf("%s\n", result.first_mismatch.c_str());
  }
  std::printf("netlist: %llu results, %llu mismatches\n", static_cast<unsigned long long>(compared),
              static_cast<unsigned long long>(mismatches));
  return mismatches == 0 && compared > 0 ? 0 : 1;
}
