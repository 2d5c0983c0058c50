#include "host/files/file_content.h"

#include <fmt/format.h>

#include <limits>

namespace emax {

void FileContent::take(FileContent whole) {
  if (!points_only()) {
    *this = std::move(whole);
    return;
  }
  first_invalid = std::move(whole.first_invalid);
  unit = whole.unit;
  resolution = whole.resolution;
  for (const Point& point : whole.vertices) add_vertex(point, {}, 0);
}

void check_count(const NamedInput& input, std::uint64_t count, std::string_view items,
                 std::uint64_t least_bytes, std::uint64_t bytes_left) {
  if (count > bytes_left / least_bytes) {
    input.fail(fmt::format("the header promises {} {}, but the rest of the file has room for {}",
                           count, items, bytes_left / least_bytes),
               kExportAgain);
  }
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    input.fail(fmt::format("{} {} are more than 32-bit indices can name", count, items),
               "split the file");
  }
}

}  // namespace emax
