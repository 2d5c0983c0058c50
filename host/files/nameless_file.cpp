#include "host/files/nameless_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace emax {

NamelessFile::NamelessFile(NamedInput input, std::string_view failure)
    : input_(std::move(input)), failure_(failure) {
  std::string pattern = (std::filesystem::temp_directory_path() / "emax_XXXXXX").string();
  descriptor_ = mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail();
  unlink(pattern.c_str());
}

NamelessFile::~NamelessFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void NamelessFile::append(std::string_view bytes) {
  write(size_, bytes);
  size_ += bytes.size();
}

void NamelessFile::write(std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

void NamelessFile::read(std::uint64_t offset, std::span<char> to) const {
  while (!to.empty()) {
    const ssize_t n = pread(descriptor_, to.data(), to.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = EIO;
    if (n <= 0) fail();
    to = to.subspan(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

int NamelessFile::release() { return std::exchange(descriptor_, -1); }

void NamelessFile::fail() const {
  input_.fail(fmt::format("{} into {} ({})", failure_,
                          std::filesystem::temp_directory_path().string(), std::strerror(errno)),
              "make room there, or name another folder by TMPDIR");
}

}  // namespace emax
