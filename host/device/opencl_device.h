#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hls/opencl/opencl_text.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/device.h"

namespace emax {

struct OpenclChoice {
  // Counts the devices of all platforms from 0, those that are no CPU first.
  std::uint32_t number = 0;
  // Points of a work item: 1, 2, 4, 8 or 16; the vector width that the device prefers if empty.
  std::optional<std::uint32_t> lanes = {};
  std::string_view text = opencl_text();
};

// The names of the hardware, in the order of the numbers. Throws Error if a driver fails.
std::vector<std::string> opencl_devices();

// The `opencl` device: a GPU, or a processor with an OpenCL driver, runs the kernel's text. Points
// and records go there as commands come, and the points' minima come back with the answer. Blocks
// are queued, so the device computes while later ones are prepared.
class OpenclDevice : public Device {
 public:
  // Compiles the kernel for the device. Throws Error if there is no such device, or if its driver
  // refuses the text.
  explicit OpenclDevice(const OpenclChoice& choice);
  ~OpenclDevice() override;

  // Compares operators and distances with the model's, on some 5,000 operands that show rounding,
  // flushing and contraction. Throws Error if a bit differs. Milliseconds.
  void verify_arithmetic();

  std::string name() const override;
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override { return {}; }

 private:
  class Commands;
  std::unique_ptr<Commands> commands_;
  CommandCursor cursor_;
};

}  // namespace emax
