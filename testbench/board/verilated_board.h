// BoardSimulation for a Verilated variant of emax_ulx3s.
#pragma once

#include <verilated.h>

#include "testbench/board/board_simulation.h"

namespace emax {

// `Model` is a class made by Verilator from emax_ulx3s with CLOCKS_PER_BIT = kClocksPerBit.
template <class Model, int kClocksPerBit>
class VerilatedBoard : public BoardSimulation {
 public:
  VerilatedBoard() { model_.ftdi_txd = 1; }
  ~VerilatedBoard() override {
    // Verilator 5.006 removes a model's scopes from the thread's present context, even if the model
    // is of another.
    Verilated::threadContextp(&context_);
    model_.final();
  }

  int clocks_per_bit() const override { return kClocksPerBit; }
  void press_reset(bool pressed) override { model_.reset_button = pressed; }
  void set_line(bool from_host) override { model_.ftdi_txd = from_host; }
  void clock() override {
    model_.clk_25mhz = 0;
    model_.eval();
    model_.clk_25mhz = 1;
    model_.eval();
  }
  bool line() const override { return model_.ftdi_rxd != 0; }
  std::uint8_t lamps() const override { return model_.led; }

 private:
  VerilatedContext context_;
  Model model_{&context_};
};

}  // namespace emax
