// Timing diagrams of what a simulation did, as WaveDrom reads them.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace emax {

// What one signal shows in one cycle: "0" or "1" of a wire, the name of a word, or nothing where a
// stream is not valid.
struct WaveValue {
  std::string signal;
  std::string value;
  bool is_wire;
};

using WaveCycle = std::vector<WaveValue>;  // the same signals in every cycle

// Cycles that are shown: from `first` to `last`, both included.
struct WaveRange {
  std::size_t first, last;
};

// The diagram as JSON, a line for each signal, under a clock. Cycles are numbered from `origin`;
// those between two ranges become a gap. Throws std::invalid_argument where a wire changes in a
// gap.
std::string wave_json(const std::vector<WaveCycle>& cycles, const std::vector<WaveRange>& shown,
                      std::size_t origin);

}  // namespace emax
