#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace emax {

// Blanks within a line.
inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
// `text` without the blanks around it.
std::string_view trimmed(std::string_view text);

// Numbers as text, independent of the locale and strict: the whole of `text` must be the number,
// with at most a '+' before it. Decimal and scientific notation, "nan", "inf". Returns nothing if
// `text` is not a number, or a number that 64 bits cannot hold (1e999, 1e-999).
std::optional<double> parse_double(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

// Whether `text` would be a number if its one comma, between two digits, were a decimal point.
bool is_decimal_comma(std::string_view text);

// The shortest decimal text that reads back as exactly `value`.
void append_shortest(std::string& text, double value);

}  // namespace emax
