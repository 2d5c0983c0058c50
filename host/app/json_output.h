#pragma once

#include <string>
#include <string_view>

namespace emax {

// Every command writes its JSON where --json leads: into a file, or with "-" to standard output.
// In that case all that the command prints for people goes to standard error.

// To be called with the option's value before anything is printed. For "-" it takes standard output
// for the JSON and empties `json`; a value that is left is a file. Throws Error where standard
// output is closed.
void direct_json(std::string& json);

bool json_is_wanted(const std::string& file);
bool standard_output_is_json();

// Writes the JSON to the file, whole or not at all, or to standard output if `file` is empty.
// Throws Error.
void write_json(const std::string& file, std::string_view bytes);

}  // namespace emax
