#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace emax {

// A file that appears whole under its name or not at all. It is written under a temporary name in
// the same folder; commit() makes it durable and renames it, and the destructor removes what was
// not committed. A program that is to leave nothing behind when interrupted therefore unwinds, or
// unlinks temporary() itself.
class AtomicFile {
 public:
  // Throws Error when nothing can be created beside `path`. A symbolic link is followed.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Throw Error, e.g. when the disk is full.
  void write(std::string_view bytes);
  void commit();

  const std::filesystem::path& temporary() const { return temporary_; }

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;  // as given, for messages
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  bool committed_ = false;
};

void write_atomically(const std::filesystem::path& path, std::string_view bytes);
// `fill` writes in pieces; when it throws, nothing is left behind.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(AtomicFile&)>& fill);

// To be asked before long work: throws Error unless `path` has one of `endings` (in lower case,
// with the dot), is no folder or device, and its folder exists and lets a file be created.
void check_output(const std::filesystem::path& path, std::span<const std::string_view> endings);

}  // namespace emax
