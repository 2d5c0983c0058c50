// A lowered design as a function in OpenCL C, for the operators of hls/opencl/binary32.cl.
#pragma once

#include <string>

#include "hls/lowering/designs.h"

namespace emax {

// One statement an operation, in the graph's order, on `real`, `condition` and `word`: vectors of
// as many lanes as the text that includes it says. Inputs of a sample are parameters in their
// order; those of a memory are read from the words of the parameter `record`. A single output is
// returned; several are written through pointers. Throws std::invalid_argument for a design with
// numbers of another format than binary32.
std::string opencl_function(const LoweredDesign& design);

}  // namespace emax
