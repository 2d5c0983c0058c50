// The modules and the logic of binary floating-point operations in generated SystemVerilog.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hls/lowering/designs.h"

namespace emax {

// "fp_add #(.SUBTRACT(1'b1), .LATENCY(ADD_LATENCY))": the operation's module of hls/rtl with its
// parameters. Those of the format come first, unless it is binary32.
std::string binary_module(const LoweredDesign& design, NodeId id);

// The port of that module that gives the result.
std::string_view binary_result_port(Operation operation);

// The expression of an operation that is plain logic on the bits of `value`: a sign or a comparison
// with zero, or of a number with itself. `canonical`: `value` is never subnormal and has one NaN
// (canonical.h).
std::string binary_logic(const LoweredDesign& design, NodeId id, const std::string& value,
                         bool canonical);

// Whether some bits of a binary number are used by no one: its sign where only magnitudes are
// taken, a part of its fraction where it is only compared with zero.
bool leaves_bits(const DataflowGraph& graph, const std::vector<bool>& canonical);

}  // namespace emax
