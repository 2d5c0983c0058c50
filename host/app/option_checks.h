#pragma once

#include <CLI/CLI.hpp>

namespace emax {

// A number, finite and above 0; `unit` names it in the complaint.
CLI::Validator positive(const std::string& unit);
// A number, both ends included. CLI::Range lets NaN pass.
CLI::Validator within(double least, double greatest);
// A whole number of 64 bits without a sign, which conversion would wrap.
CLI::Validator whole();
// For what is converted from text with a unit.
CLI::Validator not_negative();
// For texts: an empty one is what a shell makes of a variable that is not set.
CLI::Validator not_empty();

// Whether the text is UTF-8, as JSON demands of names.
bool is_utf8(const std::string& text);

}  // namespace emax
