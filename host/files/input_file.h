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

// The ending in lower case, with its dot; empty when there is none.
std::string lower_case_ending(const std::filesystem::path& path);
// The ending of the format of an input: that before .gz or .zst, and for standard input the one
// that its content shows, .xyz if it shows none.
std::string format_ending(const std::filesystem::path& path);

// Throws Error if the content, which begins with `head`, is that of another format than the one of
// `ending`.
void check_ending_fits(const NamedInput& input, std::string_view head, std::string_view ending);

// The lines of a text file that are not empty, split into fields. A field is a run of characters
// other than blanks. With a separator set, fields are the texts between separators, without the
// blanks around them.
class TextLines {
 public:
  enum class Comments { kNone, kHash, kHashOrSlashes };  // from the mark to the end of the line

  TextLines(const InputFile& input, Comments comments, std::size_t offset = 0,
            std::size_t lines_before = 0)
      : input_(input), comments_(comments), offset_(offset), line_(lines_before) {}

  // Moves to the next line that has a field. Returns false at the end of the file.
  bool next();
  // As next(), but throws Error naming `wanted` at the end of the file.
  void require_next(std::string_view wanted);
  // As require_next() for item `index` of `count`.
  void require_next(std::string_view item, std::size_t index, std::size_t count);
  // Splits this line and all later ones at `separator`; ' ' means blanks.
  void set_separator(char separator);

  std::size_t offset() const { return offset_; }  // of the first byte after the current line
  std::size_t line() const { return line_; }      // 1-based
  std::string_view text() const { return text_; }

  std::size_t size() const { return fields_.size(); }
  std::string_view operator[](std::size_t i) const { return fields_[i]; }
  // These throw Error if the field is not such a number.
  double number(std::size_t i) const;
  std::int64_t integer(std::size_t i) const;
  std::uint64_t count(std::size_t i) const;  // an integer >= 0
  Point point(std::size_t i) const;          // three numbers

  // Throws the error for a comma in place of the decimal point.
  [[noreturn]] void fail_at_decimal_comma(std::string_view text) const;

  // "<name>: line <n>: <what>; <remedy>"
  [[noreturn]] void fail(
      std::string_view what,
      std::string_view remedy = "correct the line or export the file again") const;

 private:
  void split();
  [[noreturn]] void fail_at_end(std::string_view wanted) const;

  const InputFile& input_;
  Comments comments_;
  char separator_ = ' ';
  std::size_t offset_;
  std::size_t line_;
  std::string_view text_;
  std::vector<std::string_view> fields_;
};

// `text` for a one-line message: cut at 40 characters; characters other than printable ASCII become
// '?'.
std::string printable(std::string_view text);

}  // namespace emax
