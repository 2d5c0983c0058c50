// OFF: the keyword, the counts, one vertex a line, one polygon a line.

#include <fmt/format.h>

#include "host/files/file_content.h"
#include "host/files/text_lines.h"

namespace emax {

FileContent read_off(const InputFile& input) {
  TextLines lines(input, TextLines::Comments::kHash);
  lines.require_next("the keyword OFF");
  const std::string keyword(lines[0]);
  const bool has_normals = keyword == "NOFF" || keyword == "CNOFF";
  const bool has_colours = keyword == "COFF" || keyword == "CNOFF";
  if (keyword != "OFF" && !has_normals && !has_colours) {
    lines.fail("does not begin with OFF, COFF, NOFF or CNOFF",
               "it is no OFF file that emax reads, export it as a plain OFF or PLY");
  }
  // The counts may be on the line of the keyword.
  std::size_t at = 1;
  if (lines.size() == 1) {
    lines.require_next("the counts");
    at = 0;
  }
  if (lines.size() != at + 3) lines.fail("three counts are expected: vertices, faces, edges");
  const std::uint64_t vertices = lines.count(at);
  const std::uint64_t faces = lines.count(at + 1);
  lines.count(at + 2);

  // A line has at least a digit and one byte after it for each value; only the last may end without
  // such a byte.
  const std::size_t columns = has_normals ? 6 : 3;
  const std::uint64_t room = input.bytes.size() - lines.offset() + 1;
  check_count(input, vertices, "vertices", 2 * columns, room);
  check_count(input, faces, "faces", 2, room - 2 * columns * vertices);

  FileContent content;
  if (has_normals) content.note_attribute(kNormals);
  if (has_colours) content.note_attribute(kColours);
  content.vertices.reserve(vertices);
  for (std::uint64_t i = 0; i < vertices; ++i) {
    lines.require_next("vertex", i, vertices);
    const std::size_t colours = lines.size() - std::min(columns, lines.size());
    if (lines.size() < columns || !(has_colours ? colours == 3 || colours == 4 : colours == 0)) {
      lines.fail(fmt::format("{} columns do not make a vertex of {}", lines.size(), keyword));
    }
    for (std::size_t k = columns; k < lines.size(); ++k) lines.number(k);
    content.add_vertex(lines.point(0), "line", lines.line());
    if (has_normals) content.normals.push_back(lines.point(3));
  }

  std::vector<std::int64_t> polygon;
  for (std::uint64_t i = 0; i < faces; ++i) {
    lines.require_next("face", i, faces);
    const std::uint64_t corners = lines.count(0);
    if (corners >= lines.size()) {
      lines.fail(fmt::format("{} columns do not hold a face of {} corners", lines.size(), corners));
    }
    polygon.resize(corners);
    for (std::size_t k = 0; k < corners; ++k) polygon[k] = lines.integer(k + 1);
    const std::size_t colours = lines.size() - 1 - corners;  // none, an index, RGB or RGBA
    if (colours == 2 || colours > 4) {
      lines.fail(fmt::format("{} values follow the corners of the face", colours));
    }
    if (colours > 0) content.note_attribute(kColours);
    for (std::size_t k = corners + 1; k < lines.size(); ++k) lines.number(k);
    add_polygon(content, polygon, vertices, [&](const std::string& what) { lines.fail(what); });
  }
  if (lines.next()) lines.fail("more lines than the header promises");
  return content;
}

}  // namespace emax
