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

// Times and counts after which the host reacts; times are those of the channel.
struct LinkLimits {
  using Duration = std::chrono::steady_clock::duration;

  Duration repeat = std::chrono::milliseconds(100);  // then send again, or poll
  Duration silence = std::chrono::seconds(5);        // then give up: no frame comes
  Duration standstill = std::chrono::seconds(60);    // then give up: frames come, but no progress
  Duration absence = std::chrono::seconds(30);       // then give up: the channel stays lost
  int recoveries = 8;  // new sessions without an answer between them; then give up

  // The defaults for a serial port of `baud` bits a second; a byte takes ten bits.
  static LinkLimits for_baud(std::uint32_t baud);
};

// Counts of events on the link. They count data frames unless the comment names others.
struct LinkCounters {
  std::uint64_t resends = 0;     // frames sent again to the board
  std::uint64_t repeats = 0;     // frames that the board sent again
  std::uint64_t damaged = 0;     // beginnings of frames of any kind that were damaged
  std::uint64_t misplaced = 0;   // frames out of order, or of another session
  std::uint64_t polls = 0;       // poll frames sent
  std::uint64_t recoveries = 0;  // sessions started again
  std::uint64_t losses = 0;      // losses of the channel
};

// A board behind a channel of bytes: the host's side of the link of docs/protocol.md.
//
// send() returns when all words are on the way, receive() when the answer has arrived. Both run one
// loop that sends and receives, so host and board never wait for each other. Frames that are
// damaged, lost or out of order are sent again. If a board lost its session (its power failed), or
// its channel was lost and came back, it gets all commands again whose answers it owes. Answers are
// given only once, and only whole. Results are therefore exact, or there is an Error within the
// limits; its one line names the channel and a remedy.
class LinkDevice : public Device {
 public:
  // Begins a session. Throws Error if no board answers, or if it has another version of the link.
  explicit LinkDevice(std::unique_ptr<ByteChannel> channel, const LinkLimits& limits = {});
  // Ends the board's work in progress, if the board can be reached at once.
  ~LinkDevice() override;
  LinkDevice(const LinkDevice&) = delete;
  LinkDevice& operator=(const LinkDevice&) = delete;

  std::string name() const override { return channel_->name(); }
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;  // resends, and whether it started again
  LinkCounters link_counters() const;

 private:
  using Duration = LinkLimits::Duration;

  // A data frame that is on the way to the board, kept until it is acknowledged.
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
  std::vector<std::uint8_t> output_;  // of frames begun that the channel has not taken
  bool lost_ = false;                 // the channel

  // The session.
  std::uint16_t session_;
  bool open_ = false;       // the board has accepted it
  bool ever_open_ = false;  // the board has accepted this session or an earlier one
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

  // Times of the channel: of the last bytes, valid frames, sensible acknowledgements, and progress.
  Duration received_{}, heard_{}, understood_{}, moved_{};
  Duration sent_{}, asked_{}, lost_since_{};
};

}  // namespace emax
