#include "host/run_log/record_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "sw_model/base/crc32.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");

constexpr std::array<std::uint8_t, RecordFile::kHeaderBytes> kHeader = {'e', 'm', 'a', 'x',
                                                                        'r', 'u', 'n', '1'};

std::uint32_t number_at(std::span<const std::uint8_t> bytes) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

void copy_to(std::span<std::uint8_t> to, std::span<const std::uint8_t> from) {
  if (!from.empty()) std::memcpy(to.data(), from.data(), from.size());
}

std::uint32_t checksum(std::span<const std::uint8_t> content) {
  const auto length = static_cast<std::uint32_t>(content.size());
  std::vector<std::uint8_t> checked(sizeof length + content.size());
  std::memcpy(checked.data(), &length, sizeof length);
  copy_to(std::span(checked).subspan(sizeof length), content);
  return crc32(checked);
}

// Whether the path still leads to the open file: a run that ended may have removed the file.
bool is_same_file(int descriptor, const std::filesystem::path& path) {
  struct stat open_one, named_one;
  return fstat(descriptor, &open_one) == 0 && stat(path.c_str(), &named_one) == 0 &&
         open_one.st_dev == named_one.st_dev && open_one.st_ino == named_one.st_ino;
}

}  // namespace

std::vector<std::uint8_t> record_bytes(std::span<const std::uint8_t> content) {
  if (content.size() > RecordFile::kMaximumContent) throw std::length_error("a record is too long");
  const std::array<std::uint32_t, 2> head = {static_cast<std::uint32_t>(content.size()),
                                             checksum(content)};
  static_assert(sizeof head == RecordFile::kRecordBytes);
  std::vector<std::uint8_t> bytes(sizeof head + content.size());
  std::memcpy(bytes.data(), head.data(), sizeof head);
  copy_to(std::span(bytes).subspan(sizeof head), content);
  return bytes;
}

RecordScan scan_records(std::span<const std::uint8_t> bytes) {
  RecordScan scan;
  for (std::size_t at = 0; at + RecordFile::kRecordBytes <= bytes.size();) {
    const std::span<const std::uint8_t> rest = bytes.subspan(at);
    const std::size_t length = number_at(rest);
    const bool fits =
        EMAX_FAULT(kTrustsCounts) ||
        (length <= RecordFile::kMaximumContent && length <= rest.size() - RecordFile::kRecordBytes);
    const auto content = fits ? rest.subspan(RecordFile::kRecordBytes, length) : rest.first(0);
    if (!fits || number_at(rest.subspan(4)) != checksum(content)) {
      ++at;  // search for the next whole record
      continue;
    }
    scan.damaged += at - scan.end;
    scan.records.push_back(content);
    at += RecordFile::kRecordBytes + length;
    scan.end = at;
  }
  return scan;
}

RecordFile::RecordFile(const std::filesystem::path& path) : path_(path) {
  do {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(errno);
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      close(descriptor_);
      if (error != EWOULDBLOCK) fail(error);
      throw Error(fmt::format(
          "{}: another process is at work there; wait for it or name another folder with --resume",
          path.parent_path().string()));
    }
  } while (!is_same_file(descriptor_, path));
}

RecordFile::~RecordFile() { close(descriptor_); }

RecordFile::Loss RecordFile::read(const std::function<void(std::span<const std::uint8_t>)>& take) {
  std::vector<std::uint8_t> bytes;
  while (true) {
    constexpr std::size_t kBlock = std::size_t{1} << 16;
    bytes.resize(size_ + kBlock);
    const ssize_t n = pread(descriptor_, bytes.data() + size_, kBlock, static_cast<off_t>(size_));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno);
    size_ += static_cast<std::size_t>(n);
    bytes.resize(size_);
    if (n == 0) break;
  }
  if (!std::equal(kHeader.begin(), kHeader.begin() + std::min(size_, kHeaderBytes),
                  bytes.begin())) {
    throw Error(path_.string() + ": is no log of a run; name another folder");
  }
  if (size_ < kHeaderBytes) {
    const Loss loss = {.torn = size_};
    clear();
    return loss;
  }
  const RecordScan scan = scan_records(std::span(bytes).subspan(kHeaderBytes));
  for (const auto& content : scan.records) take(content);
  const Loss loss = {.torn = size_ - kHeaderBytes - scan.end, .damaged = scan.damaged};
  if (loss.torn > 0) cut_to(kHeaderBytes + scan.end);
  return loss;
}

void RecordFile::append(std::span<const std::uint8_t> content) {
  const std::vector<std::uint8_t> bytes = record_bytes(content);
  write_at_end(bytes);
}

void RecordFile::clear() {
  cut_to(0);
  write_at_end(kHeader);
}

void RecordFile::write_at_end(std::span<const std::uint8_t> bytes) {
  std::size_t written = 0;
  int error = 0;
  while (written < bytes.size() && error == 0) {
    const ssize_t n = write(descriptor_, bytes.data() + written, bytes.size() - written);
    if (n >= 0) {
      written += static_cast<std::size_t>(n);
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  // It is an error if the file system lost the data, but not if it cannot flush.
  if (error == 0 && fdatasync(descriptor_) != 0 &&
      (errno == EIO || errno == ENOSPC || errno == EDQUOT)) {
    error = errno;
  }
  if (error != 0) {
    // If the file cannot be cut now, the torn tail is cut when the file is read.
    [[maybe_unused]] const int ignored = ftruncate(descriptor_, static_cast<off_t>(size_));
    fail(error);
  }
  size_ += bytes.size();
}

void RecordFile::cut_to(std::size_t size) {
  if (ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail(errno);
  size_ = size;
}

void RecordFile::fail(int error) const {
  throw Error(fmt::format("{}: cannot be written ({}); make room or mend the folder's permissions",
                          path_.string(), std::strerror(error)));
}

}  // namespace emax
