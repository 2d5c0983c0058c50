#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "host/files/input_file.h"

namespace emax {

// The bytes of an input, of which a window is in memory. Readers go through it from the front, so
// that a file of any size takes a few hundred kilobytes.
class InputWindow {
 public:
  // The input must outlive the window.
  explicit InputWindow(const InputStream& input);
  explicit InputWindow(const InputFile& input);  // all of it is in memory
  InputWindow(const InputWindow&) = delete;
  InputWindow& operator=(const InputWindow&) = delete;

  const NamedInput& input() const { return *input_; }
  std::uint64_t size() const { return size_; }

  // `count` bytes from `offset` on, fewer where the input ends before. Valid until the next call of
  // either. Throws Error where the file cannot be read.
  std::string_view bytes(std::uint64_t offset, std::size_t count) {
    offset = std::min(offset, size_);
    count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset));
    if (offset < begin_ || offset + count > begin_ + held_.size()) hold(offset, count);
    return held_.substr(static_cast<std::size_t>(offset - begin_), count);
  }
  // The bytes from `offset` on that stand before the next line feed, or the end.
  std::string_view line(std::uint64_t offset);

 private:
  // Moves the window of a stream.
  void hold(std::uint64_t offset, std::size_t count);

  const NamedInput* input_;
  const InputStream* stream_ = nullptr;  // where not all is in memory
  std::uint64_t size_;
  std::uint64_t begin_ = 0;  // of the window in the input
  std::string_view held_;
  std::vector<char> buffer_;
};

}  // namespace emax
