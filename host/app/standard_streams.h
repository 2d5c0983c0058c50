#pragma once

#include <string>
#include <string_view>

namespace emax {

// Those of the three that are closed lead nowhere from now on, so that no file that is opened later
// takes their place.
void open_standard_streams();

// What cannot be written there is dropped: neither a closed terminal nor a full disk ends the work.
void to_standard_error(std::string_view text) noexcept;
bool standard_error_is_terminal();

// The line cut where the terminal's next one would begin.
std::string fit_terminal(std::string line);

}  // namespace emax
