// The pins of the ULX3S design (hls/boards/ulx3s/emax_ulx3s.sv), one clock cycle at a time, for any
// Verilated variant of it.
#pragma once

#include <cstdint>
#include <memory>

namespace emax {

class BoardSimulation {
 public:
  virtual ~BoardSimulation() = default;

  virtual int clocks_per_bit() const = 0;  // of the serial line
  virtual void press_reset(bool pressed) = 0;
  virtual void set_line(bool from_host) = 0;
  virtual void clock() = 0;
  virtual bool line() const = 0;           // to the host
  virtual std::uint8_t lamps() const = 0;  // the LEDs; the highest is lit after the reset
};

// Makes the board of the program's variant. Each program links the library of one variant.
std::unique_ptr<BoardSimulation> make_board();

}  // namespace emax
