#pragma once

#include <memory>
#include <string_view>

#include "host/device/device_address.h"
#include "host/emax_search/simd_evaluator.h"

namespace emax::test {

// Of a value of --device; the CPU takes blocks too, though its engine needs none.
inline std::unique_ptr<Evaluator> evaluator_of(std::string_view device) {
  if (device == "cpu") return std::make_unique<SimdEvaluator>();
  return make_evaluator(DeviceAddress::parse(device));
}

}  // namespace emax::test
