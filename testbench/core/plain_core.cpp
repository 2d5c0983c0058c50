#include <Vemax_core_1.h>
#include <Vemax_core_2.h>
#include <Vemax_core_4.h>
#include <Vemax_device_4.h>
#include <Vemax_filter_1.h>
#include <Vemax_filter_4.h>

#include <array>
#include <string>

#include "sw_model/base/error.h"
#include "testbench/core/rtl_device.h"
#include "testbench/core/verilated_core.h"

namespace emax {
namespace {

constexpr std::array<std::uint32_t, 3> kElementCounts = {1, 2, 4};
constexpr std::array<std::uint32_t, 2> kFilterCounts = {1, 4};

}  // namespace

std::span<const std::uint32_t> rtl_element_counts() { return kElementCounts; }

std::unique_ptr<CoreSimulation> make_core(std::uint32_t elements) {
  switch (elements) {
    case 1:
      return std::make_unique<VerilatedCore<Vemax_core_1, 1>>();
    case 2:
      return std::make_unique<VerilatedCore<Vemax_core_2, 2>>();
    case 4:
      return std::make_unique<VerilatedCore<Vemax_core_4, 4>>();
    default:
      throw Error("device rtl: no core of " + std::to_string(elements) +
                  " elements is built; use 1, 2 or 4");
  }
}

std::unique_ptr<Device> make_rtl_device(std::uint32_t elements) {
  return std::make_unique<RtlDevice>(make_core(elements));
}

std::span<const std::uint32_t> rtl_filter_counts() { return kFilterCounts; }

std::unique_ptr<CoreSimulation> make_filter(std::uint32_t elements) {
  switch (elements) {
    case 1:
      return std::make_unique<VerilatedCore<Vemax_filter_1, 1>>();
    case 4:
      return std::make_unique<VerilatedCore<Vemax_filter_4, 4>>();
    default:
      throw Error("device rtl: no filtering core of " + std::to_string(elements) +
                  " elements is built; use 1 or 4");
  }
}

std::unique_ptr<Device> make_rtl_filter(std::uint32_t elements) {
  return std::make_unique<RtlDevice>(make_filter(elements));
}

std::unique_ptr<CoreSimulation> make_device() {
  return std::make_unique<VerilatedCore<Vemax_device_4, 1>>();
}

std::unique_ptr<Device> make_rtl_board() { return std::make_unique<RtlDevice>(make_device()); }

}  // namespace emax
