#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "host/block_search/evaluator.h"
#include "host/device/serial_channel.h"
#include "sw_model/protocol/cycle_model.h"

namespace emax {

// A value of --device, in one of the forms that device_help() lists.
struct DeviceAddress {
  std::string kind = "cpu";              // the part before the colon
  std::optional<BoardModel> board = {};  // of sim: the board whose time is predicted
  std::uint32_t elements = 1;            // of sim and rtl
  std::uint32_t filter_elements = 0;     // of sim and rtl: of the filter before it; 0 for none
  bool is_board = false;                 // both cores behind a store, in one stream of commands
  std::uint32_t number = 0;              // of opencl
  std::string place = {};                // of tty and xrt
  std::uint32_t baud = kDefaultBaud;

  // Throws Error naming the accepted forms.
  static DeviceAddress parse(std::string_view text);
};

// The help text of --device: every form with its meaning.
std::string device_help();

// Returns nothing for the CPU, whose engine needs no blocks. Throws Error if the device cannot be
// reached or is not compatible.
std::unique_ptr<Evaluator> make_evaluator(const DeviceAddress& address);

}  // namespace emax
