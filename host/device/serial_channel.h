#pragma once

#include <cstdint>
#include <string>

#include "sw_model/protocol/byte_channel.h"

namespace emax {

constexpr std::uint32_t kDefaultBaud = 3000000;

// A serial port in raw mode, eight bits, no parity, at any speed that its driver takes, for this
// process alone. If the port disappears (the board is unplugged), calls throw ChannelLost; reopen()
// then tries the same path again.
class SerialChannel : public ByteChannel {
 public:
  // Throws Error if the path is missing, not permitted, not a terminal, in use, or cannot run at
  // this speed.
  explicit SerialChannel(const std::string& path, std::uint32_t baud = kDefaultBaud);
  ~SerialChannel() override;
  SerialChannel(const SerialChannel&) = delete;
  SerialChannel& operator=(const SerialChannel&) = delete;

  std::string name() const override { return "tty:" + path_; }
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) override;
  std::chrono::steady_clock::duration now() override;
  bool reopen() override;  // waits 100 ms if it fails

 private:
  void open_port();
  void set_up();
  [[noreturn]] void refuse(const std::string& what);
  [[noreturn]] void lose();

  const std::string path_;
  const std::uint32_t baud_;
  int port_ = -1;
};

// Why a serial port could not be opened, for its errno, with the remedy.
std::string why_not_opened(int error);

}  // namespace emax
