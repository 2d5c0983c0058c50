#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace emax {

// The folder of a command's tiles. It outlives an interruption, and the same command goes on with
// what is there; the result removes it.
class TileFolder {
 public:
  // Throws Error if the disk has too little room for the tiles of so many points.
  TileFolder(const std::filesystem::path& path, std::uint64_t points, std::uint64_t bytes_of_point);

  // Makes the folder, or goes on with what is in it. `identity`: what the files depend on. Throws
  // Error if the folder holds something else, which stays as it is.
  void begin(const std::string& identity);
  bool is_continued() const { return continued_; }
  const std::filesystem::path& path() const { return path_; }
  void remove() const;

 private:
  std::filesystem::path path_;
  bool continued_ = false;
};

}  // namespace emax
