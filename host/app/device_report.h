#pragma once

#include <string>

#include "host/emax_search/simd_evaluator.h"
#include "host/optimize/error_constraint.h"
#include "sw_model/cycle_model.h"
#include "sw_model/device.h"

namespace emax {

// "12 blocks, 3,456,789 pairs, ...": what is not measured is left out.
std::string describe_counters(const DeviceCounters& counters);

// Does a device's work once more on the CPU's own evaluator, which searches with blocks of its own,
// and takes the time.
class CpuTwin {
 public:
  // The constraint must outlive this.
  explicit CpuTwin(const ErrorConstraint& constraint) : constraint_(constraint) {}

  // Throws Error where the CPU finds another error than the device did.
  void measure(MeshView mesh, const MeasuredError& by_device);
  double seconds() const { return seconds_; }

 private:
  const ErrorConstraint& constraint_;
  SimdEvaluator cpu_;
  double seconds_ = 0;
};

// Prints what `board` would take for the work, and what it took on this CPU.
void print_prediction(const BoardModel& board, const DeviceCounters& counters, double cpu_seconds);

}  // namespace emax
