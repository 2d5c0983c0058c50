#include <Vemax_element_mutated.h>
#include <Vemax_element_mutated___024root.h>
#include <Vemax_element_mutated_emax_mutation.h>

#include "testbench/element/verilated_element.h"
#include "testbench/element/verilated_variants.h"

namespace emax {

std::unique_ptr<ElementSimulation> make_mutated_element(std::uint32_t) {
  const auto set_active = [](Vemax_element_mutated& model, std::uint32_t mutant) {
    model.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  };
  return std::make_unique<VerilatedElement<Vemax_element_mutated, kPairsSlotBits>>(set_active);
}

}  // namespace emax
