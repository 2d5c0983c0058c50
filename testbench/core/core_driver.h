#pragma once

#include <span>
#include <vector>

#include "testbench/core/core_simulation.h"
#include "testbench/stimuli/stream_pattern.h"

namespace emax {

// When the core's two streams are willing.
struct CorePatterns {
  Pattern commands = Pattern::kAlways;
  Pattern answers = Pattern::kAlways;
  std::uint64_t seed = 1;
};

// Drives the words in and returns the core's answers, until nothing is under way. Adds the cycles
// that it took to `cycles`, if given. Throws Error when the core hangs or an assertion of the
// design fails.
std::vector<Word> run_core(CoreSimulation& core, std::span<const Word> words,
                           const CorePatterns& patterns = {}, std::uint64_t* cycles = nullptr);

// The answers of the C++ top to whole commands, and those of its twin with the filter.
std::vector<Word> answers_of_kernel(std::span<const Word> words);
std::vector<Word> answers_of_filter(std::span<const Word> words);

}  // namespace emax
