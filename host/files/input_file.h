#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Every error message about a file has the form "<name>: <what>; <remedy>".
struct NamedInput {
  std::string name;  // as the user wrote it

  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const;
};

// A file read whole.
struct InputFile : NamedInput {
  std::string bytes;
};

// An open file that is read in pieces, for formats whose points fill gigabytes. A name that ends in
// .gz or .zst is that of a compressed file, which is inflated; "-" is standard input
// (spooled_input.h).
class InputStream : public NamedInput {
 public:
  // Throws Error when `path` is missing, not a regular file or cannot be opened.
  explicit InputStream(const std::filesystem::path& path);
  ~InputStream();
  InputStream(const InputStream&) = delete;
  InputStream& operator=(const InputStream&) = delete;

  std::uint64_t size() const { return size_; }  // when it was opened, inflated
  int descriptor() const { return descriptor_; }
  // Throws Error when it is empty.
  void require_content() const;
  // Throws Error when the file ends before.
  void read(std::uint64_t offset, std::span<std::uint8_t> to) const;
  std::string head() const;  // the first bytes, those that tell the format

 private:
  std::uint64_t size_of(int descriptor) const;

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

// The remedy where the content is damaged.
inline constexpr std::string_view kExportAgain =
    "the file is truncated or damaged, copy or export it again";

// Throws Error when `path` is missing, empty, not a regular file or cannot be read.
InputFile read_input(const std::filesystem::path& path);
InputFile read_input(const InputStream& file);

// The ending in lower case, with its dot; empty when there is none.
std::string lower_case_ending(const std::filesystem::path& path);
// The ending of the format of an input: that before .gz or .zst, and for standard input the one
// that its content shows, .xyz if it shows none.
std::string format_ending(const std::filesystem::path& path);

// Bytes that tell the format.
inline constexpr std::size_t kHeadBytes = 4096;
// The ending of the format that the first bytes indicate; empty if they indicate none.
std::string_view format_of_content(std::string_view head);

// Throws Error if the content, which begins with `head`, is that of another format than the one of
// `ending`.
void check_ending_fits(const NamedInput& input, std::string_view head, std::string_view ending);

// `text` for a one-line message: cut at 40 characters; characters other than printable ASCII become
// '?'.
std::string printable(std::string_view text);

}  // namespace emax
