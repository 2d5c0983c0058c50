#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "host/files/input_file.h"

namespace emax {

// The name of standard input on the command line, and in messages.
inline constexpr std::string_view kStandardInput = "-";
inline constexpr std::string_view kStandardInputInMessages = "standard input";

enum class Compression { kNone, kGzip, kZstandard };

// By the ending .gz or .zst of a name.
Compression compression_of(const std::filesystem::path& path);
// By the first bytes.
Compression compression_of_content(std::string_view head);

// Inflates an open file, all of its members or frames, into a file without a name, in the folder
// for temporary files. Returns its descriptor. Throws Error where the file is damaged, or inflates
// beyond InflationLimit. Memory: 128 MiB at most, as the window of Zstandard.
int inflated(const NamedInput& input, int descriptor, std::uint64_t size, Compression compression);

// The first bytes of what is read once, at most kHeadBytes.
std::string head_of_pipe(const NamedInput& input, int descriptor);
// Those of standard input, which standard_input() copies all the same.
const std::string& standard_input_head();
bool standard_input_is_copied();  // by standard_input()

// A new descriptor of standard input, which is copied into a file without a name when it is first
// asked for, and inflated if it is compressed. Throws Error.
int standard_input();

}  // namespace emax
