#pragma once

#include <string_view>

namespace emax {

// The kernel as OpenCL C 1.2: the lowered distance and minimum between the operators of
// binary32.cl and the loop of blocks.cl. To be built with -DLANES= (1, 2, 4, 8 or 16 points a work
// item) and -DRECORD_WORDS=.
std::string_view opencl_text();

}  // namespace emax
