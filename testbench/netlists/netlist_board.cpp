// Drives the board's netlist and its source in lockstep. With the same input pins, the output pins
// must be the same in every cycle from the end of the reset on.
#include <Vboard_source.h>
#include <Vnetlist_board.h>

#include <cstdio>
#include <string>

#include "sw_model/base/error.h"
#include "testbench/board/verilated_board.h"

namespace emax {
namespace {

constexpr int kClocksPerBit = EMAX_CLOCKS_PER_BIT;
constexpr std::uint64_t kResetCycles = 256;  // within which the netlist must leave its reset

class LockstepBoard : public BoardSimulation {
 public:
  ~LockstepBoard() override {
    std::printf("netlist: %llu cycles in lockstep with the source\n",
                static_cast<unsigned long long>(compared_));
  }

  int clocks_per_bit() const override { return kClocksPerBit; }
  void press_reset(bool pressed) override {
    source_.press_reset(pressed);
    netlist_.press_reset(pressed);
    since_reset_ = 0;
  }
  void set_line(bool from_host) override {
    source_.set_line(from_host);
    netlist_.set_line(from_host);
  }
  void clock() override {
    source_.clock();
    netlist_.clock();
    ++cycle_;
    const bool runs = (source_.lamps() & 0x80) != 0;
    if (!runs && ++since_reset_ < kResetCycles) return;
    ++compared_;
    if (source_.line() != netlist_.line() || source_.lamps() != netlist_.lamps()) {
      throw Error("in cycle " + std::to_string(cycle_) + " the source has line " +
                  std::to_string(source_.line()) + " and lamps " + std::to_string(source_.lamps()) +
                  ", the netlist " + std::to_string(netlist_.line()) + " and " +
                  std::to_string(netlist_.lamps()));
    }
  }
  bool line() const override { return netlist_.line(); }
  std::uint8_t lamps() const override { return netlist_.lamps(); }

 private:
  VerilatedBoard<Vboard_source, kClocksPerBit> source_;
  VerilatedBoard<Vnetlist_board, kClocksPerBit> netlist_;
  std::uint64_t cycle_ = 0, since_reset_ = 0, compared_ = 0;
};

}  // namespace

std::unique_ptr<BoardSimulation> make_board() { return std::make_unique<LockstepBoard>(); }

}  // namespace emax
