#pragma once

#include <CLI/CLI.hpp>

namespace emax {

// A finite number above 0; `unit` names its unit in the error.
CLI::Validator positive(const std::string& unit);
// A number from `least` to `greatest`, both included. Unlike CLI::Range it refuses NaN.
CLI::Validator within(double least, double greatest);
// A whole number of 64 bits without a sign; CLI's conversion would wrap a negative one.
CLI::Validator whole();
// For values that are converted from text with a unit.
CLI::Validator not_negative();
// For texts. A shell passes an empty text for a variable that is not set.
CLI::Validator not_empty();
// Makes "-" of /dev/stdin, which has no ending and may be opened only once.
CLI::Validator standard_input_by_one_name();

// Whether the text is UTF-8, which JSON needs.
bool is_utf8(const std::string& text);

}  // namespace emax
