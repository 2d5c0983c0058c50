#pragma once

#include <memory>

#include "hls/kernel/emax_kernel.h"
#include "sw_model/model/flushed_float.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/cycle_model.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The `sim` device: the C++ top of the kernel on the flushing scalar, with the cycle model of a
// core of the given number of elements.
class CppDevice : public Device {
 public:
  explicit CppDevice(std::uint32_t elements = 1) : cycles_(elements) {}

  std::string name() const override { return "sim"; }
  // Takes the stream of words in parts of any length; serves a command once all its words are
  // there.
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;

 private:
  void account(Word header);

  EmaxKernel<FlushedFloat> kernel_;
  Stream<Word> commands_, answers_;
  CommandCursor cursor_;
  CycleModel cycles_;
};

}  // namespace emax
