#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace emax {

// A file that appears whole under its name or not at all. It is written under a temporary name in
// the same folder; finish() makes it durable, publish() renames it, and the destructor removes what
// was not published. A program that is to leave nothing behind when interrupted therefore unwinds,
// or unlinks temporary() itself.
class AtomicFile {
 public:
  // Throws Error when nothing can be created beside `path`. A symbolic link is followed, also to a
  // file that is not there yet; a file that is replaced passes its permissions on.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Throw Error, e.g. when the disk is full.
  void write(std::string_view bytes);
  void finish();
  void publish();  // what is finished

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
// `fill` writes in pieces; when it throws, nothing is left behind.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(AtomicFile&)>& fill);

struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
};
// All of them appear, in this order, or none: nothing is renamed before everything is on the disk.
// Only a kill or a refusal between two renames leaves the first without the rest. Throws Error.
void write_together(std::span<const OutputFile> files);

// To be asked before long work: throws Error unless `path` has one of `endings` (in lower case,
// with the dot), is no folder, device or write-protected file, and its folder exists and lets a
// file be created.
void check_output(const std::filesystem::path& path, std::span<const std::string_view> endings);
// And that nothing written replaces what is read or what else is written: throws Error where an
// output is the file of an input or of another output. Empty paths stand for none.
void check_distinct(std::initializer_list<std::filesystem::path> outputs,
                    std::initializer_list<std::filesystem::path> inputs);
// And that none of them lies in a folder whose files come and go: throws Error.
void check_outside(std::initializer_list<std::filesystem::path> outputs,
                   const std::filesystem::path& folder);

}  // namespace emax
