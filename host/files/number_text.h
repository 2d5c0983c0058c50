#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace emax {

// Numbers as text, independent of the locale and strict: the whole of `text` is the number, with
// nothing before or after it but an optional '+'. Decimal and scientific notation, "nan", "inf".
// Empty where `text` is no number, or one that 64 bit cannot hold (1e999, 1e-999).
std::optional<double> parse_double(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

// Whether `text` is a number but for one comma between two digits, in place of the decimal point.
bool is_decimal_comma(std::string_view text);

// The shortest decimal text that reads back as exactly `value`.
void append_shortest(std::string& text, double value);

}  // namespace emax
