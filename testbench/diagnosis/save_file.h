// A save file for GTKWave, which says which signals of a failure's waveform to show.
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

// The groups of signals: clock and handshakes; the failing node; its operands, each also as the
// operator reads it, delayed. Without a node, the datapath's result and the reductions after it.
std::vector<SignalGroup> signal_groups(const std::optional<NodeMismatch>& mismatch);

// The signals of an FST waveform: full name without bits -> full name with bits ("x[31:0]"). Throws
// Error where the file cannot be read.
std::map<std::string, std::string> signals_of(const std::string& waveform);

// The text of the save file beside the waveform, with the marker at `time`. Throws Error naming a
// signal that the waveform does not have.
std::string save_file(const std::vector<SignalGroup>& groups, const std::string& waveform,
                      std::uint64_t time);

}  // namespace emax
