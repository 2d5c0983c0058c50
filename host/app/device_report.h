#pragma once

#include <optional>
#include <string>

#include "host/measure/error_constraint.h"
#include "sw_model/protocol/cycle_model.h"
#include "sw_model/protocol/device.h"

namespace emax {

// "12 blocks, 3,456,789 pairs, ...": what is not measured is left out. Without a device, the
// instructions that the CPU's search uses.
std::string describe_counters(const std::optional<DeviceCounters>& counters);

// Does a device's work once more on the CPU and takes the time.
class CpuTwin {
 public:
  // The constraint must outlive this.
  explicit CpuTwin(ErrorConstraint& constraint) : constraint_(constraint) {}

  // Throws Error where the CPU finds another error than the device did.
  void measure(MeshView mesh, const MeasuredError& by_device);
  double seconds() const { return seconds_; }

 private:
  ErrorConstraint& constraint_;
  double seconds_ = 0;
};

// Prints what `board` would take for the work, and what it took on this CPU.
void print_prediction(const BoardModel& board, const DeviceCounters& counters, double cpu_seconds);

}  // namespace emax
