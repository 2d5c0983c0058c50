#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "sw_model/base/error.h"

namespace emax {

// The other end of a channel is gone: a board unplugged, a simulation ended.
struct ChannelLost : Error {
  using Error::Error;
};

// A channel of bytes to and from a board. It may damage, lose, repeat or delay them.
class ByteChannel {
 public:
  virtual ~ByteChannel() = default;

  virtual std::string name() const = 0;
  // Sends what it can at once and returns the count, which may be 0. Throws ChannelLost.
  virtual std::size_t write(std::span<const std::uint8_t> bytes) = 0;
  // Reads what has come, at most bytes.size(), and returns the count. Waits up to `wait` for the
  // first byte and returns 0 when none comes. Throws ChannelLost.
  virtual std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) = 0;
  // The clock of all time limits; a simulated board has its own.
  virtual std::chrono::steady_clock::duration now() = 0;
  // For use after ChannelLost. Waits a little; false where the other end is not back yet.
  virtual bool reopen() = 0;
};

}  // namespace emax
