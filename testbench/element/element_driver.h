// Drives a run through the element and compares every output word as it comes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "testbench/element/element_run.h"

namespace emax {

// The first difference from the model.
struct Mismatch {
  std::string stream;               // m_axis_nearest, m_axis_worst, or the rule that was broken
  std::uint64_t sample = 0;         // number of the stream's beat in the run
  std::optional<std::size_t> pair;  // the pair that caused the beat
  std::uint64_t cycle = 0;          // of the run, counted from its reset
  std::string what;                 // both values as bits
};

struct RunResult {
  std::uint64_t cycles = 0;
  std::uint64_t pairs = 0, nearest = 0, worst = 0;  // beats that passed
  // Cycles from the first accepted pair to the last, both included.
  std::uint64_t accepting_cycles = 0;
  std::optional<Mismatch> mismatch;
};

// Is told of a run's events.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void pair_accepted(std::size_t pair, std::uint64_t cycle) = 0;
  virtual void cycle_ended(std::uint64_t cycle) = 0;
};

// Resets the element and runs until every expected word has come, the run's cut is reached, or
// something is wrong: a word or tlast that differs, an additional word, no word for too long, an
// output that changes while it waits, a failed assertion of the design.
RunResult drive(ElementSimulation& element, const ElementRun& run, const Expected& expected,
                RunObserver* observer = nullptr);

}  // namespace emax
