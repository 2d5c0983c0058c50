#include "host/app/tile_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <system_error>

#include "host/files/atomic_file.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::string_view kIdentity = "command.txt";

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TileFolder::TileFolder(const std::filesystem::path& path, std::uint64_t points,
                       std::uint64_t bytes_of_point)
    : path_(path) {
  if (exists(path)) return;  // some of it is there already
  const std::filesystem::path parent = absolute(path).parent_path();
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(parent, error);
  if (error) throw Error(fmt::format("{}: {}", parent.string(), error.message()));
  if (space.available >= points * bytes_of_point) return;
  throw Error(fmt::format(
      "{}: the tiles need about {:.3g} GB, and {:.3g} GB are free; name a folder on another disk "
      "with --tile-folder",
      path.string(), static_cast<double>(points * bytes_of_point) / 1e9,
      static_cast<double>(space.available) / 1e9));
}

void TileFolder::begin(const std::string& identity) {
  std::error_code error;
  if (!create_directory(path_, error) && error) {
    throw Error(fmt::format("{}: the folder of the tiles cannot be made: {}", path_.string(),
                            error.message()));
  }
  if (is_empty(path_)) {
    write_atomically(path_ / kIdentity, identity);
    return;
  }
  if (text_of(path_ / kIdentity) != identity) {
    throw Error(fmt::format(
        "{}: holds files of another command, or of another cloud; remove the folder, or name "
        "another one with --tile-folder",
        path_.string()));
  }
  continued_ = true;
}

void TileFolder::remove() const { remove_all(path_); }

}  // namespace emax
