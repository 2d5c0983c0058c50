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

// Bytes to and from a board, which may be damaged, lost, repeated or delayed on the way.
class ByteChannel {
 public:
  virtual ~ByteChannel() = default;

  virtual std::string name() const = 0;
  // Takes what it can at once and gives the count, which may be 0. Throws ChannelLost.
  virtual std::size_t write(std::span<const std::uint8_t> bytes) = 0;
  // Gives what is there, at most bytes.size(); waits for the first byte, and gives 0 after waiting
  // in vain. Throws ChannelLost.
  virtual std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) = 0;
  // The time that limits count; a simulated board has its own.
  virtual std::chrono::steady_clock::duration now() = 0;
  // After ChannelLost; false where the other end is not back yet, after waiting a little for it.
  virtual bool reopen() = 0;
};

}  // namespace emax
