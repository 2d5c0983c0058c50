#pragma once

#include <string>
#include <string_view>

namespace emax {

// Opens those of the three streams that are closed as empty ones, so that no file that is opened
// later takes their place.
void open_standard_streams();

// Drops what is printed on standard output from now on.
void silence_standard_output();

// Writes to standard error. Text that cannot be written is dropped: neither a closed terminal nor a
// full disk ends the work.
void to_standard_error(std::string_view text) noexcept;
bool standard_error_is_terminal();

// The line, cut to the terminal's width.
std::string fit_terminal(std::string line);

}  // namespace emax
