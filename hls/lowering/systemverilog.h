// A lowered design as text: SystemVerilog for Verilator and Yosys, and what else is made of it.
#pragma once

#include <string>

#include "hls/lowering/designs.h"

namespace emax {

// The datapath: free running, without reset; schedule and ports in its header comment. Built with
// EMAX_PROBES it has one more output, every node's result. A design of words alone is
// combinational and has no clock.
std::string datapath_module(const LoweredDesign& design);

// The record memory beside the datapath, `<module>_unit`: one memory a field, each read with the
// slot delayed to the cycle that needs it. Throws std::invalid_argument for a design without
// record.
std::string unit_module(const LoweredDesign& design);

// Macros <MODULE>_LATENCY and <MODULE>_LAST_READ for what stands beside the unit.
std::string schedule_header(const LoweredDesign& design);

}  // namespace emax
