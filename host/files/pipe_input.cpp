#include "host/files/pipe_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "host/files/spooled_input.h"

namespace emax {
namespace {

[[noreturn]] void fail_to_read_pipe(const NamedInput& input) {
  input.fail(fmt::format("cannot be read ({})", std::strerror(errno)), "check who writes it");
}

int open_pipe(const NamedInput& input, const std::filesystem::path& path) {
  if (path == kStandardInput) return STDIN_FILENO;
  int descriptor = -1;
  do {
    descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  } while (descriptor < 0 && errno == EINTR);
  if (descriptor < 0) fail_to_read_pipe(input);
  return descriptor;
}

// The next bytes as they come; 0 at the end.
std::size_t read_some(const NamedInput& input, int descriptor, std::span<std::uint8_t> to) {
  while (true) {
    const ssize_t n = ::read(descriptor, to.data(), to.size());
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EINTR) fail_to_read_pipe(input);
  }
}

}  // namespace

bool is_pipe(const std::filesystem::path& path) {
  struct stat status {};
  if (path == kStandardInput) {
    if (standard_input_is_copied() || fstat(STDIN_FILENO, &status) != 0) return false;
  } else if (stat(path.c_str(), &status) != 0) {
    return false;
  }
  return S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode) || S_ISCHR(status.st_mode);
}

PipeInput::PipeInput(const std::filesystem::path& path)
    : NamedInput{path == kStandardInput ? std::string(kStandardInputInMessages) : path.string()},
      descriptor_(open_pipe(*this, path)) {
  // The pipe holds more than its usual 64 KB, where the system permits it: fewer changes between
  // who writes and who reads.
  fcntl(descriptor_, F_SETPIPE_SZ, 1 << 20);
  head_ = path == kStandardInput ? standard_input_head() : head_of_pipe(*this, descriptor_);
  at_ = head_.size();
}

PipeInput::~PipeInput() {
  if (descriptor_ != STDIN_FILENO) close(descriptor_);
}

void PipeInput::read(std::uint64_t offset, std::span<std::uint8_t> to) {
  if (offset < head_.size()) {
    const std::string_view held = head().substr(static_cast<std::size_t>(offset), to.size());
    std::ranges::copy(held, to.begin());
    to = to.subspan(held.size());
    offset += held.size();
  }
  if (to.empty()) return;
  if (offset < at_) throw std::logic_error("a pipe is read from front to back");
  const std::uint64_t gap = offset - at_;
  bool at_end = skip(gap) < gap;
  while (!at_end && !to.empty()) {
    const std::size_t n = read_some(*this, descriptor_, to);
    to = to.subspan(n);
    at_ += n;
    at_end = n == 0;
  }
  if (at_end) {
    fail(fmt::format("the stream ends after {} bytes, before its data", at_),
         "see why its writer ended, or store the scan in a file first");
  }
}

std::uint64_t PipeInput::skip(std::uint64_t most) {
  std::array<std::uint8_t, 1 << 14> forgotten{};
  std::uint64_t skipped = 0;
  while (skipped < most) {
    const auto wanted = std::min<std::uint64_t>(most - skipped, forgotten.size());
    const std::size_t n =
        read_some(*this, descriptor_, std::span(forgotten).first(static_cast<std::size_t>(wanted)));
    if (n == 0) break;
    skipped += n;
  }
  at_ += skipped;
  return skipped;
}

}  // namespace emax
