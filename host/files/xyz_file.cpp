// XYZ, ASC and PTS: one point a line.

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "host/files/file_content.h"
#include "host/files/number_text.h"
#include "host/files/text_lines.h"

namespace emax {
namespace {

// Whether the numbers of this line have decimal commas: "1,5 2,5 3,5" or "1,5, 2,5, 3,5".
bool has_decimal_commas(const TextLines& lines) {
  std::size_t with_comma = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    std::string_view field = lines[k];
    if (field.ends_with(',')) field.remove_suffix(1);
    const bool comma = is_decimal_comma(field);
    if (!comma && !parse_double(field)) return false;
    with_comma += comma ? 1 : 0;
  }
  return lines.size() >= 3 && with_comma > 0;
}

// The separator of fields, found from the first line of points, which is split at blanks. Throws
// Error where the numbers of that line have decimal commas.
char separator_of(const TextLines& lines) {
  if (lines.text().find(';') != std::string_view::npos) return ';';
  if (has_decimal_commas(lines)) lines.fail_at_decimal_comma(lines.text());
  return lines.text().find(',') == std::string_view::npos ? ' ' : ',';
}

bool is_unit(const Point& vector) { return std::abs(vector.squaredNorm() - 1) < 0.01; }

// Three columns that may be normals, with their values of every row so far.
struct NormalColumns {
  std::size_t first;
  std::vector<Point> normals;
};

// Reads rows from the current line of `lines` on. No column before `first_normal` is part of a
// normal.
void read_rows(const InputStream& input, TextLines& lines, std::size_t first_normal,
               std::optional<std::uint64_t> count, FileContent& content) {
  lines.set_separator(separator_of(lines));
  const std::size_t columns = lines.size();
  if (columns < 3) {
    lines.fail(fmt::format("{} columns are not a point, which begins with x y z", columns),
               "export x y z, or check that this is a text file of points");
  }
  std::vector<NormalColumns> candidates;
  for (std::size_t k = first_normal; k + 3 <= columns && !content.points_only(); ++k) {
    candidates.push_back({k, {}});
  }
  do {
    if (count && content.points() == *count) {
      lines.fail(fmt::format("more lines than the {} points of the first line", *count));
    }
    if (lines.size() != columns) {
      lines.fail(fmt::format("{} columns where the first point has {}", lines.size(), columns));
    }
    const Point point = lines.point(0);
    content.add_vertex(point, "line", lines.line());
    for (std::size_t k = 3; k < columns; ++k) lines.number(k);
    // The row of an invalid point may have an invalid normal. It does not exclude these columns.
    std::erase_if(candidates, [&](NormalColumns& candidate) {
      candidate.normals.push_back(lines.point(candidate.first));
      return !is_unit(candidate.normals.back()) && point.allFinite();
    });
  } while (lines.next());
  if (count && content.points() != *count) {
    input.fail(
        fmt::format("the first line promises {} points, {} follow", *count, content.points()),
        kExportAgain);
  }
  if (!candidates.empty()) content.normals = std::move(candidates.front().normals);
}

}  // namespace

void read_xyz(const InputStream& input, FileContent& content) {
  TextLines lines(input, TextLines::Comments::kHashOrSlashes);
  lines.require_next("a point");
  read_rows(input, lines, 3, std::nullopt, content);
}

void read_pts(const InputStream& input, FileContent& content) {
  TextLines lines(input, TextLines::Comments::kHashOrSlashes);
  lines.require_next("the number of points");
  std::optional<std::uint64_t> count;
  if (lines.size() == 1 && separator_of(lines) == ' ') {
    count = lines.count(0);
    lines.require_next(fmt::format("the first of {} points", *count));
  }
  read_rows(input, lines, 7, count, content);
}

}  // namespace emax
