#include <Voperators_4_3_rtl.h>
#include <Voperators_5_2_rtl.h>
#include <Voperators_8_23_rtl.h>

#include "testbench/operators/verilated_operators.h"

namespace emax {

std::unique_ptr<OperatorUnit> make_operators_8_23() {
  return std::make_unique<VerilatedOperators<Voperators_8_23_rtl>>();
}
std::unique_ptr<OperatorUnit> make_operators_4_3() {
  return std::make_unique<VerilatedOperators<Voperators_4_3_rtl>>();
}
std::unique_ptr<OperatorUnit> make_operators_5_2() {
  return std::make_unique<VerilatedOperators<Voperators_5_2_rtl>>();
}

}  // namespace emax
