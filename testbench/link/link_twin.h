#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "sw_model/protocol/byte_channel.h"
#include "sw_model/protocol/device.h"
#include "sw_model/protocol/frames.h"

namespace emax {

struct TwinSettings {
  std::chrono::steady_clock::duration byte_time = std::chrono::nanoseconds(3333);  // 3 Mbaud
  std::size_t room = 2048;                                                         // words
  std::uint32_t word_times = 1;  // byte times that the core spends on a word
  std::uint8_t version = kLinkVersion;
  bool ignores_crc = false;       // a fault that tests must catch
  bool ignores_sequence = false;  // a fault that tests must catch
};

// A plain and slow implementation of the device's side of the link (docs/protocol.md) in front of
// any core, or of a board's two with their store. In a byte time one byte passes each way and the
// core makes one step. Time passes only while read() waits.
class LinkedBoardTwin : public ByteChannel {
 public:
  using MakeCore = std::function<std::unique_ptr<Device>()>;
  explicit LinkedBoardTwin(MakeCore make_core, const TwinSettings& settings = {});

  std::string name() const override { return "twin"; }
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) override;
  std::chrono::steady_clock::duration now() override { return time_; }
  bool reopen() override { return true; }

  // Power fails and comes back.
  void power_cycle();

 private:
  void pass_byte_time();
  void receive_byte(std::uint8_t byte);
  void drop_frame();
  void take(const Frame& frame);
  void take_data(const Frame& frame);
  void forget_everything();
  void step_core();
  void take_word(Word word);
  void begin_frame();
  Frame own_frame(FrameKind kind) const;
  std::size_t credit() const { return settings_.room - commands_.size(); }

  const MakeCore make_core_;
  const TwinSettings settings_;
  std::chrono::steady_clock::duration time_{};
  std::deque<std::uint8_t> to_board_, to_host_;

  std::vector<std::uint8_t> incoming_;  // of the frame that is being read
  std::uint32_t silence_ = 0;           // byte times
  std::deque<std::uint8_t> outgoing_;

  std::optional<std::uint16_t> session_;
  std::uint8_t expected_ = 0, next_sequence_ = 0;
  std::optional<Frame> under_way_;  // the data frame that the host has not acknowledged
  bool answer_due_ = false;         // to one or more frames that came while another was sent
  bool status_due_ = false;
  bool was_short_ = false;      // the credit has been below 256 since the last status
  std::optional<Frame> reply_;  // a lost frame, or the answer to a reset of another version

  std::unique_ptr<Device> core_;
  std::deque<Word> commands_, answers_;
  std::size_t command_missing_ = 0;
  Word header_ = 0;
  std::uint32_t core_time_ = 0;
};

}  // namespace emax
