#include <Voperators_mutant_rtl.h>
#include <Voperators_mutant_rtl___024root.h>
#include <Voperators_mutant_rtl_emax_mutation.h>

#include "testbench/operators/verilated_operators.h"

namespace emax {

std::unique_ptr<OperatorUnit> make_mutant_operators(int mutant) {
  auto unit = std::make_unique<VerilatedOperators<Voperators_mutant_rtl>>();
  unit->model().eval();  // the first evaluation sets the initial value
  unit->model().eval();  // its initial blocks make the design unchanged
  unit->model().rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  return unit;
}

}  // namespace emax
