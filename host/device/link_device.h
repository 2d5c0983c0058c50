#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "host/device/command_log.h"
#include "sw_model/protocol/byte_channel.h"
#include "sw_model/protocol/device.h"
#include "sw_model/protocol/frames.h"

namespace emax {

// In the channel's own time.
struct LinkLimits {
  using Duration = std::chrono::steady_clock::duration;

  Duration repeat = std::chrono::milliseconds(100);  // then send again, or ask
  Duration silence = std::chrono::seconds(5);        // then give up: no frame comes
  Duration standstill = std::chrono::seconds(60);    // then give up: frames come, but no progress
  Duration absence = std::chrono::seconds(30);       // then give up: the channel stays lost
  int recoveries = 8;  // new sessions with no answer between them; then give up

  // The defaults for a serial port of so many bits a second, ten of which make a byte.
  static LinkLimits for_baud(std::uint32_t baud);
};

// What the link went through. Frames of data only where nothing else is said.
struct LinkCounters {
  std::uint64_t resends = 0;     // sent again to the board
  std::uint64_t repeats = 0;     // that the board sent again
  std::uint64_t damaged = 0;     // starts of frames of any kind that were none
  std::uint64_t misplaced = 0;   // ahead of their turn, or of another session
  std::uint64_t polls = 0;       // questions for a frame
  std::uint64_t recoveries = 0;  // sessions begun anew
  std::uint64_t losses = 0;      // of the channel
};

// A board behind a channel of bytes: the host's side of the link of docs/protocol.md.
//
// send() returns when all of the words are on the way; receive() when the answer is there. Both run
// one loop that sends and receives, so neither side waits for the other in a circle. What is
// damaged, lost or out of order on the way is sent again. A board that forgot its session (its
// power failed) or whose channel was lost and came back gets all commands again that it owes
// answers to. Answers are given only whole and only once, so results are exact, or there is an
// Error within the limits, in one line that names the channel and a remedy.
class LinkDevice : public Device {
 public:
  // Begins a session. Throws Error where nobody answers, or in another version of the link.
  explicit LinkDevice(std::unique_ptr<ByteChannel> channel, const LinkLimits& limits = {});
  // Leaves the board with nothing under way, if it can be reached at once.
  ~LinkDevice() override;
  LinkDevice(const LinkDevice&) = delete;
  LinkDevice& operator=(const LinkDevice&) = delete;

  std::string name() const override { return channel_->name(); }
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;  // resends, and whether it began again
  LinkCounters link_counters() const;

 private:
  using Duration = LinkLimits::Duration;

  // A data frame on the way to the board, kept until it is acknowledged.
  struct Sent {
    std::uint8_t sequence;
    std::vector<Word> payload;
  };

  template <class Done>
  void run_until(const Done& done);
  void step();
  void begin_session();
  void recover();
  void come_back();

  void fill_output();
  void put(FrameKind kind, std::uint8_t sequence = 0, const std::vector<Word>& payload = {});
  std::size_t words_to_send() const;
  std::chrono::microseconds time_to_wait() const;

  void take(const Frame& frame);
  void take_acknowledgement(const Frame& frame);
  void take_data(const Frame& frame);
  void watch_times();
  [[noreturn]] void give_up(const std::string& what) const;

  std::unique_ptr<ByteChannel> channel_;
  const LinkLimits limits_;
  CommandLog log_;
  LinkCounters counters_;
  FrameReader reader_;
  std::vector<std::uint8_t> output_;  // of frames begun, not yet taken by the channel
  bool lost_ = false;                 // the channel

  // The session.
  std::uint16_t session_;
  bool open_ = false;       // the board has taken it
  bool ever_open_ = false;  // or an earlier one
  int vain_recoveries_ = 0;
  bool reset_due_ = false, poll_due_ = false, acknowledgement_due_ = false;

  // To the board.
  std::deque<Sent> on_the_way_;
  std::size_t next_sent_ = 0;  // in on_the_way_: the next one to send again, or its size
  std::uint8_t next_sequence_ = 0;
  std::uint64_t words_acknowledged_ = 0, words_taken_ = 0, words_allowed_ = 0;
  std::size_t repeated_acknowledgements_ = 0, repeats_to_react_ = 0;

  // From the board.
  std::uint8_t expected_ = 0;

  // Times, of the channel.
  Duration received_{}, heard_{}, understood_{}, moved_{};  // bytes, frames, sense, progress
  Duration sent_{}, asked_{}, lost_since_{};
};

}  // namespace emax
