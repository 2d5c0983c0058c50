#pragma once

#include <cstdint>
#include <memory>

#include "sw_model/protocol/byte_channel.h"

namespace emax {

// The whole ULX3S design (hls/boards/ulx3s/emax_ulx3s.sv: UART, link, core of one element),
// Verilated (board_simulation.h), at the host's end of its serial line. Its line has two clocks a
// bit, so that simulation is fast: what is 3 Mbaud on the board is 60 here. Time is the board's,
// 120 MHz, and passes in read(). Equal calls give equal bytes.
class SimulatedBoard : public ByteChannel {
 public:
  SimulatedBoard();
  ~SimulatedBoard() override;

  std::string name() const override { return "simulated board"; }
  // Takes bytes until 4096 wait for the line.
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  // A board that is settled is not clocked: its time jumps to the end of the wait.
  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) override;
  std::chrono::steady_clock::duration now() override;
  bool reopen() override;

  // Nothing will come from it until something is written.
  bool settled() const;
  // Clock cycles that were simulated.
  std::uint64_t cycles() const;
  // The reset button, pressed and let go.
  void reset();
  // Takes the board's power and its end of the line: write() and read() throw ChannelLost until
  // plug() and reopen().
  void unplug();
  void plug();

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace emax
