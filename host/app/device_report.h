#pragma once

#include <optional>
#include <string>

#include "host/app/facts.h"
#include "host/measure/error_constraint.h"
#include "sw_model/protocol/cycle_model.h"
#include "sw_model/protocol/device.h"

namespace emax {

// "12 blocks, 3,456,789 pairs, ...": values that were not measured are left out. Without a device,
// the instructions that the CPU's search uses.
std::string describe_counters(const std::optional<DeviceCounters>& counters);

// Throws DeviceFailure if the device's error is not that of this processor.
void require_same(const MeasuredError& here, const MeasuredError& by_device);

// Repeats a device's work on the CPU and measures the time.
class CpuTwin {
 public:
  // The constraint must outlive this.
  explicit CpuTwin(ErrorConstraint& constraint) : constraint_(constraint) {}

  // Throws DeviceFailure if the CPU's error differs from the device's.
  void measure(MeshView mesh, const MeasuredError& by_device);
  double seconds() const { return seconds_; }

 private:
  ErrorConstraint& constraint_;
  double seconds_ = 0;
};

// Prints the time that `board` would take for the work, and the time that it took on this CPU.
void print_prediction(Facts& facts, const BoardModel& board, const DeviceCounters& counters,
                      double cpu_seconds);

}  // namespace emax
