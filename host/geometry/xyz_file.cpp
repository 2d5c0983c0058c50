// XYZ, ASC and PTS: one point a line.

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "host/geometry/file_content.h"

namespace emax {
namespace {

// What stands between two fields, judged by the first line of points.
char separator_of(std::string_view line) {
  if (line.find(';') != line.npos) return ';';
  return line.find(',') != line.npos ? ',' : ' ';
}

bool is_unit(const Point& vector) { return std::abs(vector.squaredNorm() - 1) < 0.01; }

// Reads rows from the current line of `lines` on.
FileContent read_rows(const InputFile& input, TextLines& lines, bool may_hold_normals,
                      std::optional<std::uint64_t> count) {
  FileContent content;
  lines.set_separator(separator_of(lines.text()));
  const std::size_t columns = lines.size();
  if (columns != 3 && columns != 4 && columns != 6 && columns != 7) {
    lines.fail(fmt::format("{} columns are not a point (3, 4, 6 or 7 are: x y z, intensity, "
                           "normal or colour)",
                           columns),
               "export x y z alone, or check that this is a text file of points");
  }
  bool has_normals = may_hold_normals && columns >= 6;
  do {
    if (count && content.vertices.size() == *count) {
      lines.fail(fmt::format("more lines than the {} points of the first line", *count));
    }
    if (lines.size() != columns) {
      lines.fail(fmt::format("{} columns where the first point has {}", lines.size(), columns));
    }
    content.add_vertex(lines.point(0), "line", lines.line());
    for (std::size_t k = 3; k < columns; ++k) lines.number(k);
    if (has_normals) {
      content.normals.push_back(lines.point(3));
      // The row of an invalid point may hold an invalid normal; the point is judged, not the
      // normal.
      if (!is_unit(content.normals.back()) && content.vertices.back().allFinite()) {
        has_normals = false;
        content.normals.clear();
      }
    }
  } while (lines.next());
  if (count && content.vertices.size() != *count) {
    input.fail(fmt::format("the first line promises {} points, {} follow", *count,
                           content.vertices.size()),
               kExportAgain);
  }
  return content;
}

}  // namespace

FileContent read_xyz(const InputFile& input) {
  TextLines lines(input, TextLines::Comments::kHashOrSlashes);
  lines.require_next("a point");
  return read_rows(input, lines, true, std::nullopt);
}

FileContent read_pts(const InputFile& input) {
  TextLines lines(input, TextLines::Comments::kHashOrSlashes);
  lines.require_next("the number of points");
  std::optional<std::uint64_t> count;
  if (lines.size() == 1 && separator_of(lines.text()) == ' ') {
    count = lines.count(0);
    lines.require_next(fmt::format("the first of {} points", *count));
  }
  return read_rows(input, lines, false, count);
}

}  // namespace emax
