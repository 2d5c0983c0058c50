#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "host/files/input_file.h"

namespace emax {

// Whether the path names what can be read only once, from the front: a FIFO, a device, or standard
// input ("-") that is no file and was not copied into one (spooled_input.h).
bool is_pipe(const std::filesystem::path& path);

// Such an input.
class PipeInput : public NamedInput {
 public:
  // Waits until someone writes into a FIFO. Throws Error where it cannot be read.
  explicit PipeInput(const std::filesystem::path& path);
  ~PipeInput();
  PipeInput(const PipeInput&) = delete;
  PipeInput& operator=(const PipeInput&) = delete;

  // The first bytes, at most kHeadBytes.
  std::string_view head() const { return head_; }
  bool head_is_all() const { return head_.size() < kHeadBytes; }

  // Reads from `offset` on, which lies in the head or is not before what was read. Throws Error
  // where the input ends before.
  void read(std::uint64_t offset, std::span<std::uint8_t> to);
  // Reads up to `most` bytes more and forgets them. Returns how many there were.
  std::uint64_t skip(std::uint64_t most);

 private:
  std::string head_;
  int descriptor_;
  std::uint64_t at_;  // bytes that were read
};

}  // namespace emax
