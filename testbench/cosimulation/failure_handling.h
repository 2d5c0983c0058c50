// Writes the folder of a failure in a program of the testbench.
#pragma once

#include <string>

#include "testbench/cosimulation/failure_folder.h"

namespace emax {

// Shrinks the failure and writes its folder below `parent`. Runs emax_cosim_replay, which lies
// beside the running program, to name the node and write the waveform of `window` cycles. Prints
// its progress. Returns the folder.
std::filesystem::path keep_failure(const Failure& failure, const ElementFactory& make_element,
                                   const std::filesystem::path& parent, std::uint64_t window);

// Runs emax_cosim_replay on the folder with the given further arguments. Returns its exit code, or
// 2 where it cannot be run.
int run_replay(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

}  // namespace emax
