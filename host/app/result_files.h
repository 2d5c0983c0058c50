#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace emax {

struct ResultFile {
  std::filesystem::path path;
  std::string bytes;
};

// All of them appear, in this order, or none. Throws Error.
void write_together(std::span<const ResultFile> files);

}  // namespace emax
