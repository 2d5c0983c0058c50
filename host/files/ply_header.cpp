#include "host/files/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "host/files/file_content.h"
#include "host/files/text_lines.h"

namespace emax {
namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array<TypeName, 16> kTypeNames{{{"char", PlyType::kInt8},
                                               {"uchar", PlyType::kUint8},
                                               {"short", PlyType::kInt16},
                                               {"ushort", PlyType::kUint16},
                                               {"int", PlyType::kInt32},
                                               {"uint", PlyType::kUint32},
                                               {"float", PlyType::kFloat32},
                                               {"double", PlyType::kFloat64},
                                               {"int8", PlyType::kInt8},
                                               {"uint8", PlyType::kUint8},
                                               {"int16", PlyType::kInt16},
                                               {"uint16", PlyType::kUint16},
                                               {"int32", PlyType::kInt32},
                                               {"uint32", PlyType::kUint32},
                                               {"float32", PlyType::kFloat32},
                                               {"float64", PlyType::kFloat64}}};

bool is_float(PlyType type) { return type == PlyType::kFloat32 || type == PlyType::kFloat64; }

PlyType parse_type(const TextLines& lines, std::size_t field, bool whole) {
  for (const TypeName& known : kTypeNames) {
    if (known.name == lines[field] && !(whole && is_float(known.type))) return known.type;
  }
  lines.fail(fmt::format("\"{}\" is not a PLY type that can stand here", printable(lines[field])));
}

PlyProperty parse_property(const TextLines& lines) {
  if (lines.size() == 5 && lines[1] == "list") {
    return {std::string(lines[4]), parse_type(lines, 3, false), parse_type(lines, 2, true)};
  }
  if (lines.size() != 3) lines.fail("a property needs a type and a name");
  return {std::string(lines[2]), parse_type(lines, 1, false), {}};
}

}  // namespace

PlyHeader read_ply_header(const InputStream& input) {
  TextLines lines(input, TextLines::Comments::kNone);
  if (!lines.next() || lines.line() != 1 || lines.text() != "ply") {
    input.fail("does not begin with \"ply\"",
               "it is no PLY file, give it the ending of its format");
  }
  PlyHeader header;
  bool has_format = false;
  while (true) {
    lines.require_next("\"end_header\"");
    const std::string_view word = lines[0];
    if (word == "end_header") break;
    if (word == "comment" || word == "obj_info") continue;
    if (word == "format") {
      if (lines.size() != 3 || lines[2] != "1.0" || has_format) lines.fail("no such PLY format");
      has_format = true;
      header.text = lines[1] == "ascii";
      header.big_endian = lines[1] == "binary_big_endian";
      if (!header.text && !header.big_endian && lines[1] != "binary_little_endian") {
        lines.fail("no such PLY format");
      }
    } else if (word == "element") {
      if (lines.size() != 3) lines.fail("an element needs a name and a count");
      const auto same_name = [&](const PlyElement& e) { return e.name == lines[1]; };
      if (std::ranges::any_of(header.elements, same_name)) {
        lines.fail(fmt::format("element \"{}\" appears twice", printable(lines[1])));
      }
      header.elements.push_back({std::string(lines[1]), lines.count(2), {}});
    } else if (word == "property") {
      if (header.elements.empty()) lines.fail("a property before any element");
      header.elements.back().properties.push_back(parse_property(lines));
    } else {
      lines.fail(fmt::format("unknown header word \"{}\"", printable(word)));
    }
  }
  if (!has_format) input.fail("the header names no format", kExportAgain);
  header.body = lines.offset();
  header.last_line = lines.line();
  return header;
}

std::optional<PlyCounts> ply_counts_in_parts(const InputStream& input) {
  const PlyHeader header = read_ply_header(input);
  bool has_vertices = false;
  PlyCounts counts;
  for (const PlyElement& element : header.elements) {
    const auto is_list = [](const PlyProperty& p) { return p.list_count.has_value(); };
    const bool has_lists = std::ranges::any_of(element.properties, is_list);
    if (!has_vertices && has_lists) return std::nullopt;
    if (element.name == "vertex") {
      has_vertices = true;
      counts.vertices = element.count;
    }
    if (element.name == "tristrips") return std::nullopt;
    if (element.name == "face") counts.faces = element.count;
  }
  return header.text ? std::nullopt : std::optional(counts);
}

}  // namespace emax
