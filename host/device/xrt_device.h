#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/device/card_movers.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The `xrt` device: a core on an accelerator card, between two data movers. Tested with movers in
// software, but not on a card.
//
// Command words gather in a buffer while earlier buffers are moved, so preparing, transferring and
// computing overlap. The commands tell the number of answers due. The lengths of the answers come
// from their headers, which the mover from the core reads as they pass, because an error is shorter
// than the requested result. This mover runs whenever answers are due, even while the host waits to
// send, so the core never stops because the host does not read.
class XrtDevice : public Device {
 public:
  // Longer than the longest command computes: 2^24 records over 1,024 points at 300 MHz take 57 s.
  static constexpr std::chrono::seconds kSilence{120};

  // Resets the core and drops its answers to an earlier host. Throws Error if the movers do not end
  // within `silence`.
  explicit XrtDevice(std::unique_ptr<CardMovers> movers,
                     std::chrono::milliseconds silence = kSilence);

  std::string name() const override { return movers_->name(); }
  void send(std::span<const Word> words) override;
  // Throws Error if no word comes for the time of silence.
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;

 private:
  using Clock = std::chrono::steady_clock;

  void reset();
  void gather(std::span<const Word> words);
  void start_gathered();
  bool pump(std::chrono::milliseconds wait);
  template <class Condition>
  void wait_until(Condition condition, const char* what);

  std::unique_ptr<CardMovers> movers_;
  std::chrono::milliseconds silence_;
  std::vector<Word> gathered_;
  Word gathered_answers_ = 0;  // number of answers to the gathered commands
  CommandCursor cursor_;       // in the gathered words
  std::array<bool, CardMovers::kSlots> moving_ = {};
  std::size_t slot_ = 0;               // of the next transfer
  AnswersDue due_;                     // of all commands whose transfer has started
  std::optional<AnswersDue> reading_;  // the answers that the run in progress was asked for
  std::deque<Word> answers_;
};

// Opens the card of an address "XCLBIN" or "XCLBIN@INDEX"; INDEX counts cards from 0. Throws Error
// if there is no such card, and in a build without EMAX_XRT.
std::unique_ptr<CardMovers> open_xrt_card(std::string_view address);

}  // namespace emax
