#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace emax {

// SHA-256 in 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);
// Of a file, read in pieces. Throws Error when it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace emax
