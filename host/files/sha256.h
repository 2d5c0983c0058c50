#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace emax {

// SHA-256 in 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);
// The SHA-256 of a file, which is read in pieces. Throws Error if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);
// The same, or that of a folder of scans (scan_folder.h), or of standard input, inflated.
std::string sha256_of_input(const std::filesystem::path& path);

}  // namespace emax
