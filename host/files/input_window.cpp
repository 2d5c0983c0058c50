#include "host/files/input_window.h"

#include <algorithm>
#include <span>

namespace emax {
namespace {

constexpr std::size_t kWindowBytes = std::size_t{1} << 18;

}  // namespace

InputWindow::InputWindow(const InputStream& input)
    : input_(&input), stream_(&input), size_(input.size()) {}

InputWindow::InputWindow(const InputFile& input)
    : input_(&input), size_(input.bytes.size()), held_(input.bytes) {}

void InputWindow::hold(std::uint64_t offset, std::size_t count) {
  const std::uint64_t wanted = std::max<std::uint64_t>(count, kWindowBytes);
  buffer_.resize(static_cast<std::size_t>(std::min(wanted, size_ - offset)));
  stream_->read(offset, {reinterpret_cast<std::uint8_t*>(buffer_.data()), buffer_.size()});
  begin_ = offset;
  held_ = {buffer_.data(), buffer_.size()};
}

std::string_view InputWindow::line(std::uint64_t offset) {
  for (std::size_t count = kWindowBytes / 64;; count *= 2) {
    const std::string_view text = bytes(offset, count);
    const std::size_t end = text.find('\n');
    if (end != std::string_view::npos) return text.substr(0, end);
    if (text.size() < count) return text;
  }
}

}  // namespace emax
