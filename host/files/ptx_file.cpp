// PTX: scans one after the other, each a grid of cells with a pose, one cell a line.

#include <fmt/format.h>

#include <algorithm>

#include "host/files/file_content.h"
#include "host/files/pose.h"
#include "host/files/text_lines.h"

namespace emax {
namespace {

constexpr std::uint64_t kLeastLineBytes = 6;  // of the line of a cell: "0 0 0" and its end

std::uint64_t read_one_count(TextLines& lines, std::string_view what) {
  lines.require_next(what);
  if (lines.size() != 1) lines.fail(fmt::format("{} must stand alone in its line", what));
  return lines.count(0);
}

// The scanner's place and axes, which the matrix repeats, and the matrix: points are rows before
// it.
Pose read_pose(TextLines& lines) {
  for (int i = 0; i < 4; ++i) {
    lines.require_next("the scanner's place and axes");
    if (lines.size() != 3) lines.fail("three numbers are expected: the scanner's place and axes");
    lines.point(0);
  }
  Pose pose;
  for (int row = 0; row < 4; ++row) {
    lines.require_next("a row of the pose");
    if (lines.size() != 4) lines.fail("four numbers are expected: a row of the pose");
    const Point values = lines.point(0);
    if (lines.number(3) != (row == 3 ? 1 : 0)) {
      lines.fail("the pose is not a rotation and a shift: its last column is not 0 0 0 1",
                 "export the scans with rigid poses");
    }
    if (row < 3) {
      pose.rotation.col(row) = values;
    } else {
      pose.shift = values;
    }
  }
  if (!(pose.defect() <= kGreatestDefect)) {
    lines.fail("the pose above is not a rotation and a shift: it scales, shears or reflects",
               "export the scans with rigid poses");
  }
  return pose;
}

}  // namespace

void read_ptx(const InputStream& input, FileContent& content) {
  TextLines lines(input, TextLines::Comments::kNone);
  lines.require_next("the number of columns");
  do {
    if (lines.size() != 1) {
      lines.fail("the number of columns must stand alone in the line that begins a scan");
    }
    const std::uint64_t columns = lines.count(0);
    const std::uint64_t rows = read_one_count(lines, "the number of rows");
    const Pose pose = read_pose(lines);
    const std::uint64_t room = (input.size() - lines.offset() + 1) / kLeastLineBytes;
    if (columns != 0 && rows > room / columns) {
      lines.fail(fmt::format("{} x {} cells are promised, but the rest of the file has room for {}",
                             columns, rows, room),
                 kExportAgain);
    }
    const std::uint64_t cells = columns * rows;
    check_count(input, content.index_of_next() + cells, "points", 1, input.size());
    content.scans.push_back({fmt::format("scan {}", content.scans.size()), content.points()});

    std::size_t width = 0;
    double farthest = 0;
    for (std::uint64_t i = 0; i < cells; ++i) {
      lines.require_next("cell", i, cells);
      if (i == 0) width = lines.size();
      if (lines.size() != width || (width != 3 && width != 4 && width != 7)) {
        lines.fail(fmt::format("{} columns; a cell has 4 or 7: x y z intensity, red green blue",
                               lines.size()));
      }
      for (std::size_t k = 3; k < width; ++k) lines.number(k);
      const Point point = lines.point(0);
      if (point.isZero(0)) {
        content.leave_out("empty cells");
        continue;
      }
      content.add_vertex(pose(point), "line", lines.line());
      if (point.allFinite()) farthest = std::max(farthest, point.norm());
    }
    if (width > 3) content.note_attribute("\"intensity\"");
    if (width > 4) content.note_attribute(kColours);
    content.resolution = std::max(content.resolution, pose.defect() / 2 * farthest);
  } while (lines.next());
}

}  // namespace emax
