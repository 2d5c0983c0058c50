// STL: triangles that repeat their vertices, binary in 32 bit or as text.

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "host/files/file_content.h"
#include "host/files/text_lines.h"
#include "host/geometry/merge_vertices.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

constexpr std::size_t kStlHeaderBytes = 84;  // 80 of text and the count
constexpr std::size_t kTriangleBytes = 50;

// Adds corners in triples; triangles index them until equal ones are merged.
void add_corner(FileContent& content, const Point& corner, std::string_view place,
                std::uint64_t number) {
  const auto index = static_cast<std::uint32_t>(content.vertices.size());
  content.add_vertex(corner, place, number);
  if (index % 3 == 2) content.triangles.push_back({index - 2, index - 1, index});
}

// `header`: the first bytes of the file.
std::uint32_t binary_count(std::string_view header) {
  std::uint32_t count = 0;
  static_assert(std::endian::native == std::endian::little);
  std::memcpy(&count, header.data() + kStlHeaderBytes - 4, sizeof count);
  return count;
}

// Binary files may also begin with "solid", so the size decides.
bool is_binary_file(std::string_view header, std::uint64_t size) {
  return size >= kStlHeaderBytes &&
         size == kStlHeaderBytes + std::uint64_t{binary_count(header)} * kTriangleBytes;
}

// The triangle at these bytes.
void add_binary(FileContent& content, const char* bytes, std::size_t number) {
  for (std::size_t corner = 0; corner < 3; ++corner) {
    float xyz[3];
    std::memcpy(xyz, bytes + 12 * (corner + 1), sizeof xyz);
    add_corner(content, Point(xyz[0], xyz[1], xyz[2]), "triangle", number);
  }
  // Some programs store a colour in the two bytes that the format leaves unused.
  const char* const end = bytes + kTriangleBytes;
  if (end[-2] != 0 || end[-1] != 0) content.note_attribute(kColours);
}

FileContent read_binary(const InputFile& input) {
  FileContent content;
  const std::uint32_t count = binary_count(input.bytes);
  if (count > 0xffff'ffff / 3) input.fail("more corners than 32-bit indices", "split the file");
  content.vertices.reserve(3 * std::size_t{count});
  content.triangles.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    add_binary(content, input.bytes.data() + kStlHeaderBytes + t * kTriangleBytes, t);
  }
  return content;
}

FileContent read_text(const InputFile& input) {
  FileContent content;
  TextLines lines(input, TextLines::Comments::kNone);
  const auto expect = [&](std::string_view words, std::size_t size) {
    lines.require_next(fmt::format("\"{}\"", words));
    const std::size_t gap = words.find(' ');
    const bool fits = lines.size() == size && lines[0] == words.substr(0, gap) &&
                      (gap == words.npos || lines[1] == words.substr(gap + 1));
    if (!fits) lines.fail(fmt::format("\"{}\" is expected here", words));
  };
  bool inside = false;
  std::size_t solids = 0;
  while (!inside ? lines.next() : (lines.require_next("\"endsolid\""), true)) {
    if (!inside) {
      if (lines[0] != "solid") lines.fail("\"solid\" is expected here");
      inside = true;
      if (++solids > 1) content.note_attribute(kGroups);
    } else if (lines[0] == "endsolid") {
      inside = false;
    } else {
      if (lines[0] != "facet" || lines.size() != 5 || lines[1] != "normal") {
        lines.fail("\"facet normal\" with three numbers is expected here");
      }
      for (std::size_t k = 2; k < 5; ++k) lines.number(k);
      expect("outer loop", 2);
      for (int corner = 0; corner < 3; ++corner) {
        expect("vertex", 4);
        add_corner(content, lines.point(1), "line", lines.line());
      }
      expect("endloop", 1);
      expect("endfacet", 1);
    }
  }
  return content;
}

}  // namespace

FileContent read_stl(const InputFile& input) {
  const std::size_t size = input.bytes.size();
  const bool is_binary =
      is_binary_file(input.bytes, size) || (EMAX_FAULT(kTrustsCounts) && size >= kStlHeaderBytes);
  if (!is_binary && !input.bytes.starts_with("solid")) {
    input.fail(
        size < kStlHeaderBytes
            ? "neither \"solid\" nor the 84 bytes of a binary STL header"
            : fmt::format("the header promises {} triangles, which is not what {} bytes hold",
                          binary_count(input.bytes), size),
        kExportAgain);
  }
  FileContent content = is_binary ? read_binary(input) : read_text(input);
  if (content.first_invalid.empty()) merge_equal_vertices(content.vertices, content.triangles);
  return content;
}

std::optional<std::uint64_t> stl_triangles_in_parts(const InputStream& input) {
  InputWindow window(input);
  const std::string_view header = window.bytes(0, kStlHeaderBytes);
  if (!is_binary_file(header, input.size())) return std::nullopt;
  return binary_count(header);
}

void read_stl_in_parts(const InputStream& input, FileContent& content) {
  InputWindow window(input);
  content.repeats_vertices = true;
  const std::size_t count = binary_count(window.bytes(0, kStlHeaderBytes));
  for (std::size_t t = 0; t < count; ++t) {
    const std::uint64_t at = kStlHeaderBytes + t * std::uint64_t{kTriangleBytes};
    add_binary(content, window.bytes(at, kTriangleBytes).data(), t);
    if (content.part_is_full()) content.give_part();
  }
  content.give_part();
}

}  // namespace emax
