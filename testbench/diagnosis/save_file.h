// A save file for GTKWave: which signals of a failure's waveform to show.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "testbench/diagnosis/diagnosis.h"

namespace emax {

struct SignalGroup {
  std::string heading;
  std::vector<std::string> signals;  // full names without bits: "TOP.emax_element.clk"
};

// Clock and handshakes; then the failing node, then its operands, each also delayed as the operator
// reads it. Without a node, what the datapath gives and the reductions behind it.
std::vector<SignalGroup> signal_groups(const std::optional<NodeMismatch>& mismatch);

// The signals of an FST waveform: the full name without bits, and with them ("x[31:0]"). Throws
// Error where the file cannot be read.
std::map<std::string, std::string> signals_of(const std::string& waveform);

// The text of the save file that stands beside the waveform. The marker stands at `time`. Throws
// Error naming a signal that the waveform does not have.
std::string save_file(const std::vector<SignalGroup>& groups, const std::string& waveform,
                      std::uint64_t time);

}  // namespace emax
