// Makes the Verilated variants of the element. Each function is in a library of its own, which the
// programs that need it link. slot_bits is kDeviceSlotBits or kPairsSlotBits.
#pragma once

#include <memory>
#include <string>

#include "testbench/element/element_simulation.h"

namespace emax {

// The unchanged design, fastest.
std::unique_ptr<ElementSimulation> make_plain_element(std::uint32_t slot_bits);

// The mutation build; always with 2^8 slots.
std::unique_ptr<ElementSimulation> make_mutated_element(std::uint32_t slot_bits);

// Counts coverage; always with 2^8 slots. write_coverage writes what all elements of the program
// counted since its last call.
std::unique_ptr<ElementSimulation> make_covered_element(std::uint32_t slot_bits);
void write_coverage(const std::string& file);

}  // namespace emax
