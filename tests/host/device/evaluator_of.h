#pragma once

#include <memory>
#include <string_view>

#include "host/block_search/simd_evaluator.h"
#include "host/device/device_address.h"

namespace emax::test {

// Of a value of --device; the CPU takes blocks too, though its engine needs none.
inline std::unique_ptr<Evaluator> evaluator_of(std::string_view device) {
  if (device == "cpu") return std::make_unique<SimdEvaluator>();
  return make_evaluator(DeviceAddress::parse(device));
}

}  // namespace emax::test
