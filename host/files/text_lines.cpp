#include "host/files/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "host/files/number_text.h"

namespace emax {

bool TextLines::next() {
  while (offset_ < window_.size()) {
    text_ = window_.line(offset_);
    offset_ = std::min(offset_ + text_.size() + 1, window_.size());
    ++line_;
    if (comments_ != Comments::kNone) text_ = text_.substr(0, text_.find('#'));
    if (comments_ == Comments::kHashOrSlashes) text_ = text_.substr(0, text_.find("//"));
    text_ = trimmed(text_);
    if (text_.empty()) continue;
    split();
    return true;
  }
  return false;
}

void TextLines::require_next(std::string_view wanted) {
  if (!next()) fail_at_end(wanted);
}

void TextLines::require_next(std::string_view item, std::size_t index, std::size_t count) {
  if (!next()) fail_at_end(fmt::format("{} {} of {}", item, index, count));
}

void TextLines::fail_at_end(std::string_view wanted) const {
  window_.input().fail(
      fmt::format("the file ends after line {} where {} must follow", line_, wanted), kExportAgain);
}

void TextLines::set_separator(char separator) {
  separator_ = separator;
  split();
}

void TextLines::split() {
  fields_.clear();
  if (separator_ != ' ') {
    for (std::size_t begin = 0; begin <= text_.size();) {
      const std::size_t end = std::min(text_.find(separator_, begin), text_.size());
      fields_.push_back(trimmed(text_.substr(begin, end - begin)));
      begin = end + 1;
    }
    return;
  }
  const char* at = text_.data();
  const char* const end = at + text_.size();
  while (at != end) {
    const char* const begin = at;
    while (at != end && !is_blank(*at)) ++at;
    fields_.emplace_back(begin, static_cast<std::size_t>(at - begin));
    while (at != end && is_blank(*at)) ++at;
  }
}

double TextLines::number(std::size_t i) const {
  const std::optional<double> value = parse_double(fields_[i]);
  if (value) return *value;
  if (is_decimal_comma(fields_[i])) fail_at_decimal_comma(fields_[i]);
  fail(fmt::format("\"{}\" is not a 64-bit number", printable(fields_[i])));
}

void TextLines::fail_at_decimal_comma(std::string_view text) const {
  fail(fmt::format("\"{}\" has a decimal comma", printable(text)),
       "export the file with decimal points, or replace the commas by points");
}

std::int64_t TextLines::integer(std::size_t i) const {
  const std::optional<std::int64_t> value = parse_integer(fields_[i]);
  if (!value) fail(fmt::format("\"{}\" is not a whole number", printable(fields_[i])));
  return *value;
}

std::uint64_t TextLines::count(std::size_t i) const {
  const std::int64_t value = integer(i);
  if (value < 0) fail(fmt::format("{} is negative", value));
  return static_cast<std::uint64_t>(value);
}

Point TextLines::point(std::size_t i) const {
  const double x = number(i);
  const double y = number(i + 1);
  return {x, y, number(i + 2)};
}

void TextLines::fail(std::string_view what, std::string_view remedy) const {
  window_.input().fail(fmt::format("line {}: {}", line_, what), remedy);
}

}  // namespace emax
