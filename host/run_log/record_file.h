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
// little-endian, without padding. The CRC is that of zlib. A record counts if it is complete and
// its CRC agrees. A torn last record, which a killed program or a full disk leaves, is cut off when
// the file is read. Damaged bytes before it cost the records that contain them.
class RecordFile {
 public:
  static constexpr std::size_t kHeaderBytes = 8, kRecordBytes = 8;
  static constexpr std::size_t kMaximumContent = std::size_t{1} << 20;

  // Opens or creates `path` and locks it until the destructor; the lock of a killed process is
  // released, too. Throws Error if another process has the lock or the file cannot be opened.
  explicit RecordFile(const std::filesystem::path& path);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  struct Loss {
    std::size_t torn = 0;     // bytes cut off the end
    std::size_t damaged = 0;  // bytes between whole records
  };
  // Call this once, before append(). Hands every record to `take`, in order. Throws Error if this
  // is another kind of file.
  Loss read(const std::function<void(std::span<const std::uint8_t>)>& take);

  // Once this returns, neither a kill nor a power cut can lose the record. Throws Error if it
  // cannot be written, for example on a full disk; the file then ends as before. At most
  // kMaximumContent bytes.
  void append(std::span<const std::uint8_t> content);

  // Removes all records; the lock stays.
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

// The whole records among a file's bytes after its header, and the number of lost bytes.
struct RecordScan {
  std::vector<std::span<const std::uint8_t>> records;
  std::size_t end = 0;      // of the last record
  std::size_t damaged = 0;  // bytes before `end` that are in no record
};
RecordScan scan_records(std::span<const std::uint8_t> bytes);

// The bytes of a record with this content, as they are in the file.
std::vector<std::uint8_t> record_bytes(std::span<const std::uint8_t> content);

}  // namespace emax
