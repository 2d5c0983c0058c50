// The modules and wires of fixed-point operations in generated SystemVerilog.
#pragma once

#include <string>
#include <string_view>

#include "hls/lowering/designs.h"

namespace emax {

// "fixed_add #(.WIDTH(18), .SATURATE(1'b1), .LATENCY(FIXED_ADD_LATENCY))": the operation's module
// of hls/rtl/fixed with its parameters.
std::string fixed_module(const LoweredDesign& design, NodeId id);

// The port of that module that gives the result.
std::string_view fixed_result_port(Operation operation);

// The bits of `value` that kFixedWires keeps, with what it adds.
std::string fixed_wires(const LoweredDesign& design, NodeId id, const std::string& value);

}  // namespace emax
