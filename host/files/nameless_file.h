#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "host/files/input_file.h"

namespace emax {

// A file without a name in the folder for temporary files, gone when it is closed. Every call
// throws Error that begins with the input's name and `failure`, as "cannot be unpacked".
class NamelessFile {
 public:
  NamelessFile(NamedInput input, std::string_view failure);
  ~NamelessFile();
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  void append(std::string_view bytes);
  // Several threads may write and read at a time.
  void write(std::uint64_t offset, std::string_view bytes);
  // Throws Error where the file ends before.
  void read(std::uint64_t offset, std::span<char> to) const;

  int descriptor() const { return descriptor_; }
  std::uint64_t size() const { return size_; }  // of what was appended
  // Gives the descriptor to the caller, who closes it.
  int release();

 private:
  [[noreturn]] void fail() const;

  NamedInput input_;
  std::string failure_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace emax
