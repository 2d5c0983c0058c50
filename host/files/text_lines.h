#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "host/files/input_window.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// The lines of a text file that are not empty, split into fields. A field is a run of characters
// other than blanks. With a separator set, fields are the texts between separators, without the
// blanks around them. The text of a line is valid until the next.
class TextLines {
 public:
  enum class Comments { kNone, kHash, kHashOrSlashes };  // from the mark to the end of the line

  template <class Input>  // InputFile or InputStream
  TextLines(const Input& input, Comments comments, std::uint64_t offset = 0,
            std::size_t lines_before = 0)
      : window_(input), comments_(comments), offset_(offset), line_(lines_before) {}

  // Moves to the next line that has a field. Returns false at the end of the file.
  bool next();
  // As next(), but throws Error naming `wanted` at the end of the file.
  void require_next(std::string_view wanted);
  // As require_next() for item `index` of `count`.
  void require_next(std::string_view item, std::size_t index, std::size_t count);
  // Splits this line and all later ones at `separator`; ' ' means blanks.
  void set_separator(char separator);

  std::uint64_t offset() const { return offset_; }  // of the first byte after the current line
  std::size_t line() const { return line_; }        // 1-based
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

  InputWindow window_;
  Comments comments_;
  char separator_ = ' ';
  std::uint64_t offset_;
  std::size_t line_;
  std::string_view text_;
  std::vector<std::string_view> fields_;
};

}  // namespace emax
