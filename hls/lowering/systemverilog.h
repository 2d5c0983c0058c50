// A lowered design as text: the SystemVerilog modules for Verilator and Yosys, and the header of
// the schedule.
#pragma once

#include <string>

#include "hls/lowering/designs.h"

namespace emax {

// The datapath: free running, without reset. Its header comment has the schedule and the ports.
// With EMAX_PROBES it has one more output with every node's result. A design that only has words is
// combinational and has no clock.
std::string datapath_module(const LoweredDesign& design);

// The record memory with the datapath, `<module>_unit`: one memory for each field, read with the
// slot delayed to the cycle in which the field is needed. Throws std::invalid_argument for a design
// without a record.
std::string unit_module(const LoweredDesign& design);

// The datapath between two AXI4-Streams, `<module>_stream` (hls/rtl/stream/pipeline_stream.sv); the
// unit of a design with a record between three (record_stream.sv). Throws std::invalid_argument for
// the kernel's forms, and where a port has the name of a handshake.
std::string stream_module(const LoweredDesign& design);

// Whether anything in the datapath takes a cycle; else the module has no clock.
bool is_clocked(const LoweredDesign& design);

// Macros <MODULE>_LATENCY and <MODULE>_LAST_READ for the modules that use the unit.
std::string schedule_header(const LoweredDesign& design);

}  // namespace emax
