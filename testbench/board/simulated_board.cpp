#include "testbench/board/simulated_board.h"

#include <algorithm>
#include <deque>

#include "sw_model/protocol/cycle_model.h"
#include "testbench/board/board_simulation.h"

namespace emax {
namespace {

constexpr std::size_t kWaitingBytes = 4096;
// When the line was quiet for this long, the board has no work left: the link has room for about
// 100 records, the core for a few more, and each record takes at most 1,024 cycles.
constexpr std::uint64_t kSettledCycles = 1u << 18;

}  // namespace

struct SimulatedBoard::Model {
  Model() { press(); }

  void press() {
    board->set_line(true);
    board->press_reset(true);
    for (int i = 0; i < 32; ++i) clock();
    board->press_reset(false);
    for (int i = 0; i < 64; ++i) clock();
    restart_line();
  }

  void restart_line() {
    to_board.clear();
    from_board.clear();
    sending = receiving = 0;
    quiet = 0;
  }

  void clock() {
    send();
    board->clock();
    receive();
    ++cycles;
    ++quiet;
  }

  // The host's sender: start bit, 8 bits and a stop bit of the first waiting byte.
  void send() {
    if (sending == 0) {
      if (to_board.empty()) return;
      bits_out = static_cast<unsigned>(to_board.front()) << 1 | 1u << 9;
      to_board.pop_front();
      sending = 10 * clocks_per_bit;
    }
    quiet = 0;
    board->set_line((bits_out & 1) != 0);
    if (--sending % clocks_per_bit == 0) bits_out >>= 1;
  }

  // The host's receiver samples at the first clock of each bit, because host and board have one
  // clock.
  void receive() {
    if (receiving == 0) {
      if (board->line()) return;
      receiving = 10 * clocks_per_bit;
      bits_in = 0;
    }
    quiet = 0;
    if (receiving % clocks_per_bit == 0)
      bits_in |= static_cast<unsigned>(board->line()) << (10 - receiving / clocks_per_bit);
    if (--receiving == 0) from_board.push_back(static_cast<std::uint8_t>(bits_in >> 1));
  }

  bool settled() const { return quiet >= kSettledCycles && to_board.empty(); }

  std::unique_ptr<BoardSimulation> board = make_board();
  const int clocks_per_bit = board->clocks_per_bit();
  std::deque<std::uint8_t> to_board, from_board;
  int sending = 0, receiving = 0;  // clocks left of the byte on the line
  unsigned bits_out = 0, bits_in = 0;
  std::uint64_t cycles = 0, skipped = 0, quiet = 0;
  bool plugged = true, open = true;
};

SimulatedBoard::SimulatedBoard() : model_(std::make_unique<Model>()) {}
SimulatedBoard::~SimulatedBoard() = default;

std::size_t SimulatedBoard::write(std::span<const std::uint8_t> bytes) {
  if (!model_->open) throw ChannelLost("the simulated board is unplugged");
  const std::size_t count = std::min(bytes.size(), kWaitingBytes - model_->to_board.size());
  model_->to_board.insert(model_->to_board.end(), bytes.begin(),
                          bytes.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

std::size_t SimulatedBoard::read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) {
  Model& model = *model_;
  if (!model.open) throw ChannelLost("the simulated board is unplugged");
  std::uint64_t left =
      kUlx3sClockMhz * static_cast<std::uint64_t>(std::max<std::int64_t>(0, wait.count()));
  while (model.from_board.empty() && left > 0) {
    if (model.settled()) {
      model.skipped += left;
      break;
    }
    model.clock();
    --left;
  }
  const std::size_t count = std::min(bytes.size(), model.from_board.size());
  const auto end = model.from_board.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(model.from_board.begin(), end, bytes.begin());
  model.from_board.erase(model.from_board.begin(), end);
  return count;
}

std::chrono::steady_clock::duration SimulatedBoard::now() {
  return std::chrono::nanoseconds((model_->cycles + model_->skipped) * 1000 / kUlx3sClockMhz);
}

bool SimulatedBoard::settled() const { return model_->settled() && model_->from_board.empty(); }
std::uint64_t SimulatedBoard::cycles() const { return model_->cycles; }
void SimulatedBoard::reset() { model_->press(); }

void SimulatedBoard::unplug() { model_->plugged = model_->open = false; }

void SimulatedBoard::plug() {
  if (model_->plugged) return;
  model_->plugged = true;
  model_->press();
}

bool SimulatedBoard::reopen() { return model_->open = model_->plugged; }

}  // namespace emax
