#include <Vemax_core_mutated.h>
#include <Vemax_core_mutated___024root.h>
#include <Vemax_core_mutated_emax_mutation.h>

#include <Vemax_filter_mutated.h>
#include <Vemax_filter_mutated___024root.h>
#include <Vemax_filter_mutated_emax_mutation.h>

#include <Vemax_device_mutated.h>
#include <Vemax_device_mutated___024root.h>
#include <Vemax_device_mutated_emax_mutation.h>

#include <Vemax_sdram_device_mutated.h>
#include <Vemax_sdram_device_mutated___024root.h>
#include <Vemax_sdram_device_mutated_emax_mutation.h>

#include "testbench/core/verilated_core.h"

namespace emax {

std::unique_ptr<CoreSimulation> make_mutated_core() {
  const auto set_active = [](Vemax_core_mutated& model, std::uint32_t mutant) {
    model.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  };
  return std::make_unique<VerilatedCore<Vemax_core_mutated, 2>>(set_active);
}

std::unique_ptr<CoreSimulation> make_mutated_filter() {
  const auto set_active = [](Vemax_filter_mutated& model, std::uint32_t mutant) {
    model.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  };
  return std::make_unique<VerilatedCore<Vemax_filter_mutated, 2>>(set_active);
}

std::unique_ptr<CoreSimulation> make_mutated_device() {
  const auto set_active = [](Vemax_device_mutated& model, std::uint32_t mutant) {
    model.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  };
  return std::make_unique<VerilatedCore<Vemax_device_mutated, 1>>(set_active);
}

std::unique_ptr<CoreSimulation> make_mutated_device_with_sdram() {
  const auto set_active = [](Vemax_sdram_device_mutated& model, std::uint32_t mutant) {
    model.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  };
  return std::make_unique<VerilatedCore<Vemax_sdram_device_mutated, 1>>(set_active);
}

}  // namespace emax
