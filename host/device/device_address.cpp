#include "host/device/device_address.h"

#include "host/device/device_evaluator.h"
#include "host/emax_search/simd_evaluator.h"
#include "sw_model/cpp_device.h"
#include "sw_model/error.h"
#include "testbench/rtl_device.h"

namespace emax {

DeviceAddress DeviceAddress::parse(std::string_view text) {
  constexpr std::string_view kBoard = "sim:board=";
  if (text == "cpu" || text == "sim" || text == "rtl") {
    return {std::string(text), std::nullopt};
  }
  if (text.starts_with(kBoard)) return {"sim", board_model(text.substr(kBoard.size()))};
  throw Error("unknown device '" + std::string(text) + "'; use cpu, sim, sim:board=NAME or rtl");
}

std::unique_ptr<Evaluator> make_evaluator(const DeviceAddress& address) {
  if (address.kind == "cpu") return std::make_unique<SimdEvaluator>();
  if (address.kind == "rtl") {
    return std::make_unique<DeviceEvaluator>(std::make_unique<RtlDevice>());
  }
  return std::make_unique<DeviceEvaluator>(
      std::make_unique<CppDevice>(address.board ? address.board->elements : 1));
}

}  // namespace emax
