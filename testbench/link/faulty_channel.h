#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sw_model/protocol/byte_channel.h"
#include "sw_model/protocol/frames.h"
#include "testbench/stimuli/random.h"

namespace emax {

// Probabilities of faults in one direction.
struct ByteFaults {
  double flip = 0;   // per byte: one of its bits changes
  double drop = 0;   // per byte: it is lost
  double twice = 0;  // per byte: it comes twice
  double burst = 0;  // per byte: it and up to 63 that follow become garbage
  double swap = 0;   // per frame: it comes after one to three of the next frames
};

struct FaultCounts {
  std::uint64_t flips = 0, drops = 0, doubles = 0, bursts = 0, swaps = 0, garbage = 0, stalls = 0,
                unplugs = 0;
  std::string text() const;
};

// A channel with faults in front of another channel. Equal seeds and calls give equal faults.
class FaultyChannel : public ByteChannel {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // The inner channel must outlive it.
  FaultyChannel(ByteChannel& inner, std::uint64_t seed, const ByteFaults& to_board = {},
                const ByteFaults& to_host = {});

  // Inserts `count` bytes of garbage now, in both directions.
  void add_garbage(std::size_t count);
  // Lets nothing pass for this time.
  void stall(Duration time);
  // The channel is lost and can be opened again after this time.
  void unplug(Duration time);
  // Calls `action` once `count` bytes have gone to the board.
  void after_bytes(std::uint64_t count, std::function<void()> action);
  const FaultCounts& counts() const { return counts_; }
  std::uint64_t bytes_to_board() const { return bytes_to_board_; }

  std::string name() const override { return inner_.name(); }
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) override;
  Duration now() override { return inner_.now() + absence_; }
  bool reopen() override;

 private:
  struct Direction {
    ByteFaults faults;
    std::deque<std::uint8_t> bytes = {};  // on the way
    FrameReader reader = {};              // where frames are swapped
    std::optional<Frame> held = {};
    std::uint32_t held_for = 0;  // frames
    std::uint32_t burst_left = 0;
  };
  struct Action {
    std::uint64_t bytes;
    std::function<void()> act;
  };

  void pass(std::span<const std::uint8_t> bytes, Direction& direction);
  void swap_frames(std::span<const std::uint8_t> bytes, Direction& direction);
  void damage(std::span<const std::uint8_t> bytes, Direction& direction);
  bool happens(double probability);
  bool stalled() { return now() < stalled_until_; }
  void require_plugged();
  void flush();

  ByteChannel& inner_;
  Random random_;
  Direction to_board_, to_host_;
  FaultCounts counts_;
  std::uint64_t bytes_to_board_ = 0;
  std::vector<Action> actions_;
  Duration stalled_until_{}, absence_{};
  std::optional<Duration> back_at_;
};

}  // namespace emax
