#include <Voperators_covered_rtl.h>

#include "testbench/operators/verilated_operators.h"

namespace emax {

std::unique_ptr<OperatorUnit> make_covered_operators() {
  return std::make_unique<VerilatedOperators<Voperators_covered_rtl>>();
}

}  // namespace emax
