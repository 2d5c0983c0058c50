#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace emax {

// A file that grows by whole records and survives being cut anywhere. It begins with eight bytes,
// "emaxrun1"; a record is
//   length of the content (32 bit) | CRC-32 of the length and the content (32 bit) | content
// little-endian, without padding. The CRC is that of zlib. A record counts when all of it is there
// and its CRC agrees: what a killed program or a full disk left of the last one is cut off when the
// file is read, and bytes damaged further in cost the records they lie in.
class RecordFile {
 public:
  static constexpr std::size_t kHeaderBytes = 8, kRecordBytes = 8;
  static constexpr std::size_t kMaximumContent = std::size_t{1} << 20;

  // Opens or creates `path` and locks it until this goes; the lock of a killed process goes with
  // it. Throws Error when another process has the lock or the file cannot be opened.
  explicit RecordFile(const std::filesystem::path& path);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  struct Loss {
    std::size_t torn = 0;     // bytes cut off the end
    std::size_t damaged = 0;  // bytes between whole records
  };
  // To be called once, before append: hands every record to `take`, in order. Throws Error when
  // this is another kind of file.
  Loss read(const std::function<void(std::span<const std::uint8_t>)>& take);

  // Neither a kill nor a power cut can lose the record once this returns. Throws Error when it
  // cannot be written, a full disk for one; the file then ends as before. At most kMaximumContent
  // bytes.
  void append(std::span<const std::uint8_t> content);

  // All records go; the lock stays.
  void clear();

  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(int error) const;
  void write_at_end(std::span<const std::uint8_t> bytes);
  void cut_to(std::size_t size);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

// The whole records of a file's bytes after its header, and what is lost between and behind them.
struct RecordScan {
  std::vector<std::span<const std::uint8_t>> records;
  std::size_t end = 0;      // of the last record
  std::size_t damaged = 0;  // bytes before `end` that are in no record
};
RecordScan scan_records(std::span<const std::uint8_t> bytes);

// A content as it stands in the file.
std::vector<std::uint8_t> record_bytes(std::span<const std::uint8_t> content);

}  // namespace emax
