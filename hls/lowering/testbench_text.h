#pragma once

#include <string>

#include "hls/lowering/designs.h"

namespace emax {

// The main of a testbench for Verilator: the module V<name> beside the function of the header that
// it was lowered from (testbench/lowered/function_bench.h). Throws std::invalid_argument for one of
// the kernel's forms, which have testbenches.
std::string testbench_source(const LoweredDesign& design);

// The same for the module V<name>_unit of unit_module; throws for a design without a record too.
std::string unit_testbench_source(const LoweredDesign& design);

// The same for the module V<name>_stream of stream_module.
std::string stream_testbench_source(const LoweredDesign& design);

}  // namespace emax
