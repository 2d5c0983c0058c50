#pragma once

#include <cstdint>
#include <string>

#include "sw_model/protocol/byte_channel.h"

namespace emax {

constexpr std::uint32_t kDefaultBaud = 3000000;

// A serial port, raw, eight bits, no parity, at any speed its driver takes, and ours alone. A port
// that goes away (a board unplugged) is ChannelLost; reopen() then looks for the same path.
class SerialChannel : public ByteChannel {
 public:
  // Throws Error where the path is missing, not permitted, no terminal, in use or too fast for it.
  explicit SerialChannel(const std::string& path, std::uint32_t baud = kDefaultBaud);
  ~SerialChannel() override;
  SerialChannel(const SerialChannel&) = delete;
  SerialChannel& operator=(const SerialChannel&) = delete;

  std::string name() const override { return "tty:" + path_; }
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) override;
  std::chrono::steady_clock::duration now() override;
  bool reopen() override;  // waits 100 ms in vain

 private:
  void open_port();
  void set_up();
  [[noreturn]] void refuse(const std::string& what);
  [[noreturn]] void lose();

  const std::string path_;
  const std::uint32_t baud_;
  int port_ = -1;
};

// What hinders the opening of a serial port, by its errno, and the remedy.
std::string why_not_opened(int error);

}  // namespace emax
