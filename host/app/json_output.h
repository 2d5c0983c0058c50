#pragma once

#include <string>
#include <string_view>

namespace emax {

// Every command writes its JSON to the target of --json: a file, or standard output for "-". With
// "-" all text of the command goes to standard error.

// Call this with the option's value before anything is printed. For "-" it reserves standard output
// for the JSON and empties `json`; otherwise `json` stays and is a file. Throws Error if standard
// output is closed.
void direct_json(std::string& json);

bool json_is_wanted(const std::string& file);
bool standard_output_is_json();

// Writes the JSON to the file, whole or not at all, or to standard output if `file` is empty.
// Throws Error.
void write_json(const std::string& file, std::string_view bytes);

}  // namespace emax
