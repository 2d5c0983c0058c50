#pragma once

#include <deque>
#include <memory>
#include <span>

#include "sw_model/protocol/device.h"
#include "testbench/core/core_simulation.h"

namespace emax {

// The `rtl` device: a Verilated core. It is clocked while words go in and while an answer is
// awaited. Its cycles are those that the core counts (kCounters).
class RtlDevice : public Device {
 public:
  explicit RtlDevice(std::unique_ptr<CoreSimulation> core);

  std::string name() const override { return "rtl"; }
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override { return {}; }

 private:
  void clock(const Word* word);

  std::unique_ptr<CoreSimulation> core_;
  std::deque<Word> answers_;
};

// The numbers of elements for which a core is built.
std::span<const std::uint32_t> rtl_element_counts();

// Throws Error for any other number of elements, naming those that are built.
std::unique_ptr<CoreSimulation> make_core(std::uint32_t elements);
std::unique_ptr<Device> make_rtl_device(std::uint32_t elements = 1);

// The same of filtering cores.
std::span<const std::uint32_t> rtl_filter_counts();
std::unique_ptr<CoreSimulation> make_filter(std::uint32_t elements);
std::unique_ptr<Device> make_rtl_filter(std::uint32_t elements);

// Both cores of a board behind its store, without its link (hls/rtl/board/emax_device.sv).
constexpr std::uint32_t kRtlBoardFilterElements = 4;  // before one exact element
constexpr unsigned kRtlBoardStoreBits = 14;
std::unique_ptr<CoreSimulation> make_device();
std::unique_ptr<Device> make_rtl_board();

}  // namespace emax
