#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "host/emax_search/evaluator.h"
#include "sw_model/cycle_model.h"

namespace emax {

// A value of --device: `cpu`, `sim`, `sim:board=NAME` or `rtl`.
struct DeviceAddress {
  std::string kind = "cpu";
  std::optional<BoardModel> board;  // whose time is predicted; its elements are simulated

  // Throws Error naming what is accepted.
  static DeviceAddress parse(std::string_view text);
};

std::unique_ptr<Evaluator> make_evaluator(const DeviceAddress& address);

}  // namespace emax
