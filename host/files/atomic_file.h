#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace emax {

// A file that appears under its name either whole or not at all. It is written under a temporary
// name in the same folder; finish() makes it durable, publish() renames it, and the destructor
// removes it if it was not published. A program that must leave nothing behind when it is
// interrupted therefore unwinds its stack, or unlinks temporary() itself.
class AtomicFile {
 public:
  // Throws Error when no file can be created beside `path`. A symbolic link is followed, even to a
  // file that does not exist yet. A file that is replaced passes its permissions on.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Throw Error, e.g. when the disk is full.
  void write(std::string_view bytes);
  void finish();
  void publish();  // after finish()

  const std::filesystem::path& temporary() const { return temporary_; }

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;  // as given, for messages
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  bool published_ = false;
};

void write_atomically(const std::filesystem::path& path, std::string_view bytes);
// `fill` writes in pieces. If it throws, nothing is left behind.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(AtomicFile&)>& fill);

struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
};
// All files appear, in this order, or none: every file is on the disk before the first is renamed.
// Only a kill or a refusal between two renames can leave some without the others. Throws Error.
void write_together(std::span<const OutputFile> files);

// Call this before long work. Throws Error unless `path` has one of `endings` (in lower case, with
// the dot), is not a folder, a device or a write-protected file, and its folder exists and a file
// can be created in it.
void check_output(const std::filesystem::path& path, std::span<const std::string_view> endings);
// Throws Error if an output is the same file as an input or another output. Empty paths are
// ignored.
void check_distinct(std::initializer_list<std::filesystem::path> outputs,
                    std::initializer_list<std::filesystem::path> inputs);
// Throws Error if an output lies in `folder`, whose files the program creates and removes.
void check_outside(std::initializer_list<std::filesystem::path> outputs,
                   const std::filesystem::path& folder);

}  // namespace emax
