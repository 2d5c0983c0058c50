#pragma once

#include <cstdint>
#include <memory>

#include "sw_model/protocol/byte_channel.h"

namespace emax {

// The whole ULX3S design (hls/boards/ulx3s/emax_ulx3s.sv: UART, link, core of one element),
// Verilated (board_simulation.h), at the host's end of its serial line. The line has two clocks a
// bit, which makes the simulation fast: 45 Mbaud instead of the board's 3. Time is the board's
// (kUlx3sClockMhz), and passes in read(). Equal calls give equal bytes.
class SimulatedBoard : public ByteChannel {
 public:
  SimulatedBoard();
  ~SimulatedBoard() override;

  std::string name() const override { return "simulated board"; }
  // Takes bytes until 4096 bytes wait for the line.
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  // A settled board is not clocked: its time jumps to the end of the wait.
  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) override;
  std::chrono::steady_clock::duration now() override;
  bool reopen() override;

  // Whether nothing will come from the board until something is written.
  bool settled() const;
  // Clock cycles that were simulated.
  std::uint64_t cycles() const;
  // The reset button, pressed and let go.
  void reset();
  // Cuts the board's power and line: write() and read() throw ChannelLost until plug() and
  // reopen().
  void unplug();
  void plug();

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace emax
