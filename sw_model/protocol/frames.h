#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hls/kernel/word.h"

namespace emax {

// The frames of the link (docs/protocol.md).
enum class FrameKind : std::uint8_t { kReset = 1, kData = 2, kStatus = 3, kPoll = 4, kLost = 5 };

// Raised whenever frames or the commands in them change.
constexpr std::uint8_t kLinkVersion = 2;
constexpr std::uint8_t kSync[2] = {0x4d, 0xe5};
constexpr std::size_t kFrameHeaderBytes = 12;
constexpr std::size_t kFrameCrcBytes = 4;
constexpr std::size_t kMaxFrameWords = 256;

struct Frame {
  FrameKind kind;  // may be an unknown number in a frame that was read
  std::uint16_t session = 0;
  std::uint8_t sequence = 0, expected = 0;
  std::uint16_t credit = 0;
  std::vector<Word> payload = {};
  std::uint8_t version = kLinkVersion;

  bool operator==(const Frame&) const = default;
};

// Throws std::invalid_argument for a payload above kMaxFrameWords.
std::vector<std::uint8_t> encode(const Frame& frame);

// Hunts for frames in any stream of bytes, checks length and CRC, and gives whole frames. After a
// false start the hunt goes on from the byte after its sync bytes, so no frame is lost by it.
class FrameReader {
 public:
  void add(std::span<const std::uint8_t> bytes);
  std::optional<Frame> next();
  // Drops the frame that is being read, because its rest will not come, and hunts on. next() may
  // then give frames that were taken for part of it.
  void abandon();
  // The number of false starts: sync bytes that began no frame.
  std::uint64_t dropped() const { return dropped_; }

 private:
  std::span<const std::uint8_t> rest() const { return std::span(bytes_).subspan(start_); }
  bool hunt();
  void drop();

  std::vector<std::uint8_t> bytes_;  // those from start_ on are not yet taken
  std::size_t start_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace emax
