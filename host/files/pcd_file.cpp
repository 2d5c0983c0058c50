// PCD (Point Cloud Library): a text header, then values as text, binary or LZF-compressed binary.

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include "host/files/file_content.h"
#include "host/files/number_text.h"
#include "host/files/text_lines.h"

namespace emax {
namespace {

struct Field {
  std::string name;
  std::size_t size = 4;  // bytes of one value
  char type = 'F';
  // The number of values. It is negative only for padding "_": the Point Cloud Library's writer
  // moves back so where the fields of a type are not in the order of its memory. It writes no
  // column of text for such padding.
  std::int64_t count = 1;
  std::int64_t bytes() const { return static_cast<std::int64_t>(size) * count; }
};

constexpr std::int64_t kMostValues = 65536;

enum class Data { kText, kBinary, kCompressed };

struct PcdHeader {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  Data data = Data::kText;
  std::uint64_t body = 0;
  std::size_t last_line = 0;

  std::size_t point_bytes() const {
    std::int64_t sum = 0;
    for (const Field& f : fields) sum += f.bytes();
    return static_cast<std::size_t>(sum);
  }
  std::size_t columns() const {
    std::int64_t sum = 0;
    for (const Field& f : fields) sum += std::max<std::int64_t>(f.count, 0);
    return static_cast<std::size_t>(sum);
  }
};

void check_field(const TextLines& lines, const Field& field) {
  const bool is_integer_size =
      field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
  const bool known = field.type == 'F' ? field.size == 4 || field.size == 8
                     : field.type == 'B'
                         ? field.size == 1
                         : (field.type == 'I' || field.type == 'U') && is_integer_size;
  if (!known) {
    lines.fail(fmt::format("field \"{}\" of type {} and {} bytes is no PCD field",
                           printable(field.name), field.type, field.size));
  }
}

PcdHeader read_pcd_header(const InputStream& input) {
  TextLines lines(input, TextLines::Comments::kHash);
  PcdHeader header;
  std::optional<std::uint64_t> width, height, points;
  while (true) {
    lines.require_next("the line \"DATA\"");
    const std::string_view key = lines[0];
    const auto value_of_each_field = [&](auto&& set) {
      if (header.fields.empty() || lines.size() != header.fields.size() + 1) {
        lines.fail("needs one value for each of FIELDS, which must stand before it");
      }
      for (std::size_t i = 0; i < header.fields.size(); ++i) set(header.fields[i], i + 1);
    };
    if (key == "FIELDS" || key == "COLUMNS") {
      if (!header.fields.empty()) lines.fail("FIELDS appears twice");
      for (std::size_t i = 1; i < lines.size(); ++i) {
        header.fields.emplace_back().name = std::string(lines[i]);
      }
    } else if (key == "SIZE") {
      value_of_each_field([&](Field& f, std::size_t i) { f.size = lines.count(i); });
    } else if (key == "TYPE") {
      value_of_each_field(
          [&](Field& f, std::size_t i) { f.type = lines[i].size() == 1 ? lines[i][0] : '?'; });
    } else if (key == "COUNT") {
      value_of_each_field([&](Field& f, std::size_t i) {
        f.count = lines.integer(i);
        if (f.count < (f.name == "_" ? -kMostValues : 1) || f.count > kMostValues) {
          lines.fail(fmt::format("COUNT is outside 1..{}", kMostValues));
        }
      });
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
      if (lines.size() != 2) lines.fail("needs one number");
      (key == "WIDTH" ? width : key == "HEIGHT" ? height : points) = lines.count(1);
    } else if (key == "DATA") {
      const std::string_view data = lines.size() == 2 ? lines[1] : std::string_view();
      if (data == "ascii") {
        header.data = Data::kText;
      } else if (data == "binary") {
        header.data = Data::kBinary;
      } else if (data == "binary_compressed") {
        header.data = Data::kCompressed;
      } else {
        lines.fail("DATA is none of ascii, binary, binary_compressed");
      }
      break;
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      lines.fail(fmt::format("unknown header word \"{}\"", printable(key)));
    }
  }
  std::int64_t offset = 0;
  std::int64_t greatest = 0;
  for (const Field& field : header.fields) {
    check_field(lines, field);
    offset += field.bytes();
    greatest = std::max(greatest, offset);
    if (offset < 0) break;
  }
  if (offset < greatest) {
    input.fail("a field of the header ends outside of its point", kExportAgain);
  }
  if (!points && width) points = *width * height.value_or(1);
  if (!points) input.fail("the header has neither POINTS nor WIDTH", kExportAgain);
  const auto product_is_points = [&] {
    return *height == 0 ? *points == 0 : *points % *height == 0 && *points / *height == *width;
  };
  if (width && height && !product_is_points()) {
    input.fail(fmt::format("POINTS {} is not WIDTH {} x HEIGHT {}", *points, *width, *height),
               kExportAgain);
  }
  header.points = *points;
  header.body = lines.offset();
  header.last_line = lines.line();
  return header;
}

// The position of a coordinate: the field, its column in a text line, its byte offset in a point.
struct Place {
  const Field* field;
  std::size_t column;
  std::size_t offset;
};
using ThreePlaces = std::array<Place, 3>;

std::optional<ThreePlaces> find_three(const PcdHeader& header,
                                      const std::array<std::string_view, 3>& names) {
  ThreePlaces places{};
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t column = 0;
    std::int64_t offset = 0;
    for (const Field& field : header.fields) {
      if (field.name == names[k] && field.count == 1 && places[k].field == nullptr) {
        places[k] = {&field, column, static_cast<std::size_t>(offset)};
      }
      column += static_cast<std::size_t>(std::max<std::int64_t>(field.count, 0));
      offset += field.bytes();
    }
    if (places[k].field == nullptr) return std::nullopt;
  }
  return places;
}

template <class Number>
double load(const char* bytes) {
  static_assert(std::endian::native == std::endian::little);
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double load(const Field& field, const char* bytes) {
  if (field.type == 'F') return field.size == 4 ? load<float>(bytes) : load<double>(bytes);
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? load<std::int8_t>(bytes) : load<std::uint8_t>(bytes);
    case 2:
      return is_signed ? load<std::int16_t>(bytes) : load<std::uint16_t>(bytes);
    case 4:
      return is_signed ? load<std::int32_t>(bytes) : load<std::uint32_t>(bytes);
    default:
      return is_signed ? load<std::int64_t>(bytes) : load<std::uint64_t>(bytes);
  }
}

// The decompressed body: all values of the first field, then all of the second, ...
std::string decompress(const InputStream& input, const PcdHeader& header, std::uint64_t wanted) {
  const std::uint64_t room = input.size() - header.body;
  std::array<std::uint32_t, 2> sizes{};  // compressed, uncompressed
  if (room < sizeof sizes) input.fail("the file ends before its compressed data", kExportAgain);
  input.read(header.body, {reinterpret_cast<std::uint8_t*>(sizes.data()), sizeof sizes});
  if (sizes[0] > room - sizeof sizes) {
    input.fail(fmt::format("{} bytes of compressed data are promised, {} follow", sizes[0],
                           room - sizeof sizes),
               kExportAgain);
  }
  // LZF makes at most 264 bytes from 3.
  if (sizes[1] != wanted || wanted > 88 * std::uint64_t{sizes[0]}) {
    input.fail(
        fmt::format("{} bytes of data cannot be the promised {} points", sizes[1], header.points),
        kExportAgain);
  }
  std::vector<std::uint8_t> compressed(sizes[0]);
  input.read(header.body + sizeof sizes, compressed);
  std::string data(sizes[1], '\0');
  if (lzf_decompress(compressed.data(), sizes[0], data.data(), sizes[1]) != sizes[1]) {
    input.fail("the compressed data are damaged", kExportAgain);
  }
  return data;
}

bool is_point(const TextLines& lines, std::size_t columns) {
  if (lines.size() != columns) return false;
  for (std::size_t k = 0; k < columns; ++k) {
    if (!parse_double(lines[k])) return false;
  }
  return true;
}

}  // namespace

// Writers pad the data to whole pages of memory. Bytes after the last point are therefore ignored,
// as the Point Cloud Library's reader ignores them. A further line of text that is a point is
// refused, because it contradicts the header.
void read_pcd(const InputStream& input, FileContent& content) {
  const PcdHeader header = read_pcd_header(input);
  const auto coordinates = find_three(header, {"x", "y", "z"});
  if (!coordinates) {
    input.fail("the header has no FIELDS x, y and z",
               "it is no PCD file with coordinates, export it with these fields");
  }
  const auto normal = content.points_only()
                          ? std::nullopt
                          : find_three(header, {"normal_x", "normal_y", "normal_z"});
  const std::uint64_t room = input.size() - header.body;
  const std::size_t point_bytes = header.point_bytes();

  // `pass(left)`: how many of the next points need not be read.
  const auto add_all = [&](std::string_view place, auto&& value, auto&& number, auto&& pass) {
    content.expect_points(header.points);
    const auto three = [&](const ThreePlaces& at, std::size_t i) {
      Point point;
      for (int k = 0; k < 3; ++k) point[k] = value(at[static_cast<std::size_t>(k)], i);
      return point;
    };
    for (std::size_t i = 0; i < header.points; ++i) {
      if (const std::uint64_t passed = pass(header.points - i)) {
        i += passed - 1;
        continue;
      }
      const std::uint64_t n = number(i);
      content.add_vertex(three(*coordinates, i), place, n);
      if (normal) content.normals.push_back(three(*normal, i));
    }
  };
  const auto vertex_number = [](std::size_t i) { return i; };
  const auto read_all = [](std::uint64_t) { return std::uint64_t{0}; };

  if (header.data == Data::kText) {
    check_count(input, header.points, "points", 2 * header.columns(), room + 1);
    TextLines lines(input, TextLines::Comments::kNone, header.body, header.last_line);
    const auto next_line = [&](std::size_t i) {
      lines.require_next("point", i, header.points);
      if (lines.size() != header.columns()) {
        lines.fail(
            fmt::format("{} columns where the header promises {}", lines.size(), header.columns()));
      }
      for (std::size_t k = 0; k < lines.size(); ++k) lines.number(k);
      return lines.line();
    };
    add_all(
        "line", [&](const Place& p, std::size_t) { return lines.number(p.column); }, next_line,
        read_all);
    if (lines.next() && is_point(lines, header.columns())) {
      lines.fail(fmt::format("more points than the {} of the header", header.points));
    }
    return;
  }

  if (header.data == Data::kBinary) {
    check_count(input, header.points, "points", point_bytes, room);
    InputWindow window(input);
    add_all(
        "vertex",
        [&](const Place& p, std::size_t i) {
          const std::uint64_t at = header.body + i * point_bytes + p.offset;
          return load(*p.field, window.bytes(at, p.field->size).data());
        },
        vertex_number, [&](std::uint64_t left) { return content.pass_unwanted(left); });
    return;
  }

  // The format itself has 32-bit sizes here.
  check_count(input, header.points, "points", point_bytes,
              std::numeric_limits<std::uint32_t>::max());
  const std::string body = decompress(input, header, header.points * point_bytes);
  add_all(
      "vertex",
      [&](const Place& p, std::size_t i) {
        return load(*p.field, body.data() + header.points * p.offset + i * p.field->size);
      },
      vertex_number, read_all);
}

}  // namespace emax
