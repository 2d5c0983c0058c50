// Wavefront OBJ: one element a line. Its first word is its kind.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/files/file_content.h"
#include "host/files/number_text.h"
#include "host/files/text_lines.h"

namespace emax {
namespace {

// Elements that do not change the shape, with the attribute that each adds to the mesh; empty:
// none.
struct PassedOver {
  std::string_view word, attribute;
};
constexpr std::array<PassedOver, 12> kPassedOver{{{"vt", kTextureCoordinates},
                                                  {"vp", ""},
                                                  {"o", kGroups},
                                                  {"g", kGroups},
                                                  {"s", "smoothing groups"},
                                                  {"mg", "smoothing groups"},
                                                  {"usemtl", kMaterials},
                                                  {"mtllib", kMaterials},
                                                  {"usemap", kMaterials},
                                                  {"maplib", kMaterials},
                                                  {"l", "lines"},
                                                  {"p", "points"}}};

// The 0-based index for a 1-based index, or for a negative one that counts back from the last of
// `count`.
std::int64_t resolve(std::int64_t index, std::size_t count) {
  return index < 0 ? static_cast<std::int64_t>(count) + index : index - 1;
}

// One corner of a face: v, v/vt, v//vn or v/vt/vn.
struct Corner {
  std::int64_t vertex;
  std::int64_t normal;  // -1 when there is none
};

Corner parse_corner(const TextLines& lines, std::size_t field, const FileContent& content) {
  std::string_view rest = lines[field];
  std::array<std::optional<std::int64_t>, 3> parts;
  for (std::size_t k = 0;; ++k) {
    const std::size_t end = std::min(rest.find('/'), rest.size());
    const std::string_view part = rest.substr(0, end);
    if (k < 3) parts[k] = parse_integer(part);
    const bool may_be_empty = k == 1 && end != rest.size();
    if (k == 3 || (!parts[k] && !(part.empty() && may_be_empty)) || parts[k] == 0) {
      lines.fail(fmt::format("\"{}\" is not a corner v, v/vt, v//vn or v/vt/vn with indices from 1",
                             printable(lines[field])));
    }
    if (end == rest.size()) break;
    rest.remove_prefix(end + 1);
  }
  return {resolve(*parts[0], content.vertices.size()),
          parts[2] ? resolve(*parts[2], content.normals.size()) : -1};
}

}  // namespace

FileContent read_obj(const InputFile& input) {
  FileContent content;
  TextLines lines(input, TextLines::Comments::kHash);
  // A face may come before its vertices, so the greatest index is checked at the end.
  std::int64_t greatest = -1;
  std::size_t greatest_line = 0;
  bool one_normal_per_vertex = true;
  constexpr std::uint64_t kNoLimit = 0xffff'ffff;
  std::vector<std::int64_t> polygon;
  while (lines.next()) {
    if (lines[0] == "v") {
      // x y z, then a weight, a colour or both.
      const std::size_t columns = lines.size() - 1;
      if (columns != 3 && columns != 4 && columns != 6 && columns != 7) {
        lines.fail(fmt::format("{} columns do not make a vertex", columns));
      }
      for (std::size_t k = 4; k <= columns; ++k) lines.number(k);
      if (columns >= 6) content.note_attribute(kColours);
      content.add_vertex(lines.point(1), "line", lines.line());
    } else if (lines[0] == "vn") {
      if (lines.size() != 4) lines.fail("a normal needs three numbers");
      content.normals.push_back(lines.point(1));
      content.note_attribute(kNormals);
    } else if (lines[0] == "f") {
      polygon.clear();
      for (std::size_t k = 1; k < lines.size(); ++k) {
        const Corner corner = parse_corner(lines, k, content);
        if (corner.vertex > greatest) {
          greatest = corner.vertex;
          greatest_line = lines.line();
        }
        if (corner.normal != -1 && corner.normal != corner.vertex) one_normal_per_vertex = false;
        polygon.push_back(corner.vertex);
      }
      add_polygon(content, polygon, kNoLimit, [&](const std::string& what) { lines.fail(what); });
    } else {
      const auto known = std::ranges::find(kPassedOver, lines[0], &PassedOver::word);
      if (known == kPassedOver.end()) {
        lines.fail(fmt::format("\"{}\" is not an OBJ element that emax reads", printable(lines[0])),
                   "export polygons, or check that this is an OBJ file");
      }
      if (!known->attribute.empty()) content.note_attribute(known->attribute);
    }
  }
  if (greatest >= static_cast<std::int64_t>(content.vertices.size())) {
    input.fail(fmt::format("line {}: vertex {} of only {}", greatest_line, greatest + 1,
                           content.vertices.size()),
               kExportAgain);
  }
  if (content.vertices.size() > kNoLimit) {
    input.fail("more vertices than 32-bit indices can name", "split the file");
  }
  if (!one_normal_per_vertex || content.normals.size() != content.vertices.size()) {
    content.normals.clear();
  }
  return content;
}

}  // namespace emax
