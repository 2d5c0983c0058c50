#include <array>

#include "sw_model/base/error.h"
#include "testbench/core/rtl_device.h"

namespace emax {

std::span<const std::uint32_t> rtl_element_counts() {
  static constexpr std::array<std::uint32_t, 1> kCounts = {1};
  return kCounts;
}

namespace {

[[noreturn]] void refuse_absent_rtl() {
  throw Error(
      "device rtl: this emax was built without the simulated hardware; install verilator and build "
      "with cmake -DEMAX_RTL=ON, or take --device sim");
}

}  // namespace

std::unique_ptr<Device> make_rtl_device(std::uint32_t) { refuse_absent_rtl(); }
std::unique_ptr<Device> make_rtl_filter(std::uint32_t) { refuse_absent_rtl(); }
std::unique_ptr<Device> make_rtl_board() { refuse_absent_rtl(); }

}  // namespace emax
