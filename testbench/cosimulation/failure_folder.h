// The folder that a failure leaves. It holds everything that is needed to see the failure again:
//
//   input.txt      test, seed, slot bits, mutant and the runs (element_run.h), after # the reason
//   replay.sh      replays the failure, from any folder, with the build that wrote it
//   report.txt     what the replay found: the mismatch, the pair, the first diverging node and its
//                  operands
//   waveform.fst   a window of the failing run
//   waveform.gtkw  opens it in GTKWave: clock, handshakes, the node, its operands
//
// A copy of the folder under tests/testbench/regressions is a test of the unchanged design.
#pragma once

#include <filesystem>

#include "testbench/cosimulation/cosimulation.h"

namespace emax {

// "pairs: random bits", seed 7 -> "pairs-random-bits-7"
std::string folder_name(const Failure& failure);

// The path of emax_cosim_replay, which lies beside the running program.
std::filesystem::path replay_program();

// Throws Error where the folder cannot be written.
void write_failure(const std::filesystem::path& folder, const Failure& failure);

// Reads all but the mismatch. Throws Error naming the file and what is wrong in it.
Failure read_failure(const std::filesystem::path& folder);

// One paragraph: test, seed, sample, cycle, values.
std::string describe(const Failure& failure);

}  // namespace emax
