#include <Vemax_element_plain.h>
#include <Vemax_element_plain_device.h>

#include "testbench/element/verilated_element.h"
#include "testbench/element/verilated_variants.h"

namespace emax {

std::unique_ptr<ElementSimulation> make_plain_element(std::uint32_t slot_bits) {
  if (slot_bits == kDeviceSlotBits) {
    return std::make_unique<VerilatedElement<Vemax_element_plain_device, kDeviceSlotBits>>();
  }
  return std::make_unique<VerilatedElement<Vemax_element_plain, kPairsSlotBits>>();
}

}  // namespace emax
