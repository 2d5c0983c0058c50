// The Verilated variants of the element. Each function is in a library of its own, linked by the
// programs that need it; slot_bits is kDeviceSlotBits or kPairsSlotBits.
#pragma once

#include <memory>
#include <string>

#include "testbench/element/element_simulation.h"

namespace emax {

// The unchanged design, fastest.
std::unique_ptr<ElementSimulation> make_plain_element(std::uint32_t slot_bits);

// The mutation build; 2^8 slots only, whatever is asked for.
std::unique_ptr<ElementSimulation> make_mutated_element(std::uint32_t slot_bits);

// Counts coverage; 2^8 slots only. write_coverage writes what all elements of the program counted
// since it was called last.
std::unique_ptr<ElementSimulation> make_covered_element(std::uint32_t slot_bits);
void write_coverage(const std::string& file);

}  // namespace emax
