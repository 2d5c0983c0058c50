// DXF as text: the 3DFACEs of the ENTITIES section and $INSUNITS of the header.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/files/dxf_units.h"
#include "host/files/file_content.h"
#include "host/files/number_text.h"

namespace emax {
namespace {

// Entities of surfaces that this reader does not have. Without them the shape would have holes.
constexpr std::array<std::string_view, 8> kOtherSurfaces = {
    "3DSOLID", "BODY", "INSERT", "MESH", "POLYLINE", "REGION", "SOLID", "SURFACE"};

// The pairs of a group code and its value, a line each.
class Groups {
 public:
  explicit Groups(const InputFile& input) : input_(input) {}

  // Moves to the next pair. Throws Error at the end of the file, which "EOF" must end.
  void next() {
    const std::string_view text = line();
    const std::optional<std::int64_t> number = parse_integer(text);
    if (!number) fail(fmt::format("\"{}\" is not a group code", printable(text)));
    code_ = *number;
    value_ = line();
  }
  std::int64_t code() const { return code_; }
  std::string_view value() const { return value_; }
  bool is(std::int64_t code, std::string_view value) const {
    return code_ == code && value_ == value;
  }
  double number() const {
    const std::optional<double> value = parse_double(value_);
    if (!value) fail(fmt::format("\"{}\" is not a 64-bit number", printable(value_)));
    return *value;
  }
  std::uint64_t line_number() const { return lines_; }
  [[noreturn]] void fail(std::string_view what) const {
    input_.fail(fmt::format("line {}: {}", lines_, what), "export it again as a text DXF file");
  }

 private:
  std::string_view line() {
    const std::string_view bytes = input_.bytes;
    if (at_ == bytes.size()) {
      input_.fail(fmt::format("the file ends after line {} without \"EOF\"", lines_), kExportAgain);
    }
    const std::size_t end = std::min(bytes.find('\n', at_), bytes.size());
    std::string_view text = bytes.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes.size());
    ++lines_;
    constexpr std::string_view kBlanks = " \t\r";
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
  }

  const InputFile& input_;
  std::size_t at_ = 0;
  std::uint64_t lines_ = 0;
  std::int64_t code_ = 0;
  std::string_view value_;
};

class Drawing {
 public:
  explicit Drawing(const InputFile& input) : input_(input), groups_(input) {}

  FileContent read() {
    if (input_.bytes.starts_with("AutoCAD Binary DXF")) {
      input_.fail("is a binary DXF file", "export it as a text DXF file");
    }
    for (groups_.next(); !groups_.is(0, "EOF"); groups_.next()) {
      if (groups_.code() == 999) continue;  // a comment
      if (!groups_.is(0, "SECTION")) groups_.fail("\"SECTION\" is expected here");
      groups_.next();
      const std::string section(groups_.value());
      groups_.next();
      if (section == "HEADER") {
        read_header();
      } else if (section == "ENTITIES") {
        read_entities();
      } else {
        while (!groups_.is(0, "ENDSEC")) groups_.next();
      }
    }
    content_.repeats_vertices = true;
    return std::move(content_);
  }

 private:
  void read_header() {
    for (; !groups_.is(0, "ENDSEC"); groups_.next()) {
      if (!groups_.is(9, "$INSUNITS")) continue;
      groups_.next();
      const std::optional<std::int64_t> number = parse_integer(groups_.value());
      const auto known =
          std::ranges::find_if(kDxfUnits, [&](const auto& u) { return u.first == number; });
      if (known != kDxfUnits.end()) content_.unit = unit_named(known->second);
    }
  }

  void read_entities() {
    while (!groups_.is(0, "ENDSEC")) {
      const std::string name(groups_.value());
      if (groups_.code() != 0) groups_.fail("an entity is expected here");
      if (std::ranges::find(kOtherSurfaces, name) != kOtherSurfaces.end()) {
        input_.fail(fmt::format("line {}: the entity {} is not read", groups_.line_number(), name),
                    "explode it to 3DFACE entities, or export the mesh as .ply");
      }
      groups_.next();
      if (name == "3DFACE") {
        read_face();
      } else {
        content_.note_attribute(fmt::format("\"{}\"", printable(name)));
        while (groups_.code() != 0) groups_.next();
      }
    }
  }

  void read_face() {
    std::array<Point, 4> corners;
    unsigned seen = 0;  // a bit for each coordinate
    for (; groups_.code() != 0; groups_.next()) {
      const std::int64_t axis = groups_.code() / 10 - 1, corner = groups_.code() % 10;
      if (axis < 0 || axis > 2 || corner < 0 || corner > 3) continue;
      corners[static_cast<std::size_t>(corner)][axis] = groups_.number();
      seen |= 1u << (4 * axis + corner);
    }
    if (seen != 0xfff) groups_.fail("the 3DFACE before this line lacks a coordinate");
    const auto first = static_cast<std::int64_t>(content_.vertices.size());
    const bool is_triangle = corners[3] == corners[2];
    const std::array<std::int64_t, 4> polygon = {first, first + 1, first + 2, first + 3};
    const std::size_t size = is_triangle ? 3 : 4;
    for (std::size_t k = 0; k < size; ++k) {
      content_.add_vertex(corners[k], "the 3DFACE before line", groups_.line_number());
    }
    add_polygon(content_, std::span(polygon).first(size), content_.vertices.size(),
                [&](const std::string& what) { groups_.fail(what); });
  }

  const InputFile& input_;
  Groups groups_;
  FileContent content_;
};

}  // namespace

FileContent read_dxf(const InputFile& input) { return Drawing(input).read(); }

}  // namespace emax
