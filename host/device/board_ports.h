#pragma once

#include <memory>

#include "sw_model/protocol/device.h"

namespace emax {

// The two cores of a board as two devices: `exact` and `filter` send into one stream of commands,
// and each receives the answers to its own. Both are used by one thread, and send() gets whole
// commands. Store commands (hls/kernel/command_words.h) may be sent to either.
struct BoardPorts {
  std::unique_ptr<Device> exact, filter;
};
BoardPorts ports_of(std::unique_ptr<Device> board);

}  // namespace emax
