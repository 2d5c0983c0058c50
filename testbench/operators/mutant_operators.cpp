#include <Voperators_mutant_rtl.h>
#include <Voperators_mutant_rtl___024root.h>
#include <Voperators_mutant_rtl_emax_mutation.h>

#include "testbench/operators/verilated_operators.h"

namespace emax {

std::unique_ptr<OperatorUnit> make_mutant_operators(int mutant) {
  auto unit = std::make_unique<VerilatedOperators<Voperators_mutant_rtl>>();
  // Two evaluations, so that initial values and initial blocks do not overwrite the mutant's
  // number.
  unit->model().eval();
  unit->model().eval();
  unit->model().rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  return unit;
}

}  // namespace emax
