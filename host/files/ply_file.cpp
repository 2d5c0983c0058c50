// PLY: a text header that names elements and their properties, then their values as text or binary.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "host/files/file_content.h"
#include "host/files/text_lines.h"

namespace emax {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array<TypeName, 16> kTypeNames{{{"char", Type::kInt8},
                                               {"uchar", Type::kUint8},
                                               {"short", Type::kInt16},
                                               {"ushort", Type::kUint16},
                                               {"int", Type::kInt32},
                                               {"uint", Type::kUint32},
                                               {"float", Type::kFloat32},
                                               {"double", Type::kFloat64},
                                               {"int8", Type::kInt8},
                                               {"uint8", Type::kUint8},
                                               {"int16", Type::kInt16},
                                               {"uint16", Type::kUint16},
                                               {"int32", Type::kInt32},
                                               {"uint32", Type::kUint32},
                                               {"float32", Type::kFloat32},
                                               {"float64", Type::kFloat64}}};

bool is_float(Type type) { return type == Type::kFloat32 || type == Type::kFloat64; }

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Type type;
  std::optional<Type> list_count;  // set for a list: the type of its length
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

struct PlyHeader {
  bool text = false;
  bool big_endian = false;
  std::vector<Element> elements;
  std::uint64_t body = 0;     // offset of the first byte of values
  std::size_t last_line = 0;  // of the header
};

Type parse_type(const TextLines& lines, std::size_t field, bool whole) {
  for (const TypeName& known : kTypeNames) {
    if (known.name == lines[field] && !(whole && is_float(known.type))) return known.type;
  }
  lines.fail(fmt::format("\"{}\" is not a PLY type that can stand here", printable(lines[field])));
}

Property parse_property(const TextLines& lines) {
  if (lines.size() == 5 && lines[1] == "list") {
    return {std::string(lines[4]), parse_type(lines, 3, false), parse_type(lines, 2, true)};
  }
  if (lines.size() != 3) lines.fail("a property needs a type and a name");
  return {std::string(lines[2]), parse_type(lines, 1, false), {}};
}

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
      const auto same_name = [&](const Element& e) { return e.name == lines[1]; };
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

// The values of a text body: one line for each item, without spare values.
class TextValues {
 public:
  static constexpr std::string_view kPlace = "line";
  static std::size_t least_bytes(Type) { return 2; }  // a digit and the byte that ends it
  static std::size_t slack() { return 1; }            // the last digit may end the file

  TextValues(const InputStream& input, const PlyHeader& header)
      : lines_(input, TextLines::Comments::kNone, header.body, header.last_line) {}

  void begin_item(const Element& element, std::uint64_t index) {
    lines_.require_next(element.name, index, element.count);
    field_ = 0;
  }
  double number(Type) { return lines_.number(take()); }
  std::int64_t integer(Type) { return lines_.integer(take()); }
  void skip(Type, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) lines_.number(take());
  }
  bool has_room(Type, std::uint64_t count) const { return count <= lines_.size() - field_; }
  static constexpr bool kCanPass = false;  // where a line begins is not known
  void pass(std::uint64_t) {}
  void end_item() {
    if (field_ != lines_.size()) {
      lines_.fail(fmt::format("{} values where {} are expected", lines_.size(), field_));
    }
  }
  void end() {
    if (lines_.next()) lines_.fail("more lines than the header promises");
  }
  std::uint64_t place(std::uint64_t) const { return lines_.line(); }
  [[noreturn]] void fail(std::string_view what) const { lines_.fail(what); }

 private:
  std::size_t take() {
    if (field_ == lines_.size()) lines_.fail(fmt::format("only {} values", lines_.size()));
    return field_++;
  }

  TextLines lines_;
  std::size_t field_ = 0;
};

class BinaryValues {
 public:
  static constexpr std::string_view kPlace = "vertex";
  static std::size_t least_bytes(Type type) { return size_of(type); }
  static std::size_t slack() { return 0; }

  BinaryValues(const InputStream& input, const PlyHeader& header)
      : window_(input), at_(header.body), swap_(header.big_endian) {
    static_assert(std::endian::native == std::endian::little);
  }

  void begin_item(const Element& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  double number(Type type) {
    switch (type) {
      case Type::kFloat32:
        return std::bit_cast<float>(take<std::uint32_t>());
      case Type::kFloat64:
        return std::bit_cast<double>(take<std::uint64_t>());
      default:
        return static_cast<double>(integer(type));
    }
  }
  std::int64_t integer(Type type) {
    switch (type) {
      case Type::kInt8:
        return static_cast<std::int8_t>(take<std::uint8_t>());
      case Type::kUint8:
        return take<std::uint8_t>();
      case Type::kInt16:
        return static_cast<std::int16_t>(take<std::uint16_t>());
      case Type::kUint16:
        return take<std::uint16_t>();
      case Type::kInt32:
        return static_cast<std::int32_t>(take<std::uint32_t>());
      case Type::kUint32:
        return take<std::uint32_t>();
      default:
        fail(fmt::format("property of {} must be of a whole-number type", element_->name));
    }
  }
  void skip(Type type, std::uint64_t count) {
    if (!has_room(type, count)) fail_at_end();
    at_ += count * size_of(type);
  }
  bool has_room(Type type, std::uint64_t count) const {
    return count <= (window_.size() - at_) / size_of(type);
  }
  static constexpr bool kCanPass = true;
  void pass(std::uint64_t bytes) { at_ += bytes; }
  void end_item() {}
  void end() {
    if (at_ != window_.size()) {
      window_.input().fail(fmt::format("{} bytes follow the last element", window_.size() - at_),
                           kExportAgain);
    }
  }
  std::uint64_t place(std::uint64_t index) const { return index; }
  [[noreturn]] void fail(std::string_view what) const {
    window_.input().fail(fmt::format("{} {}: {}", element_->name, index_, what), kExportAgain);
  }

 private:
  [[noreturn]] void fail_at_end() const {
    fail(fmt::format("the file ends inside it, {} are promised", element_->count));
  }

  template <class Word>
  Word take() {
    const std::string_view held = window_.bytes(at_, sizeof(Word));
    if (held.size() < sizeof(Word)) fail_at_end();
    std::array<char, sizeof(Word)> bytes;
    std::memcpy(bytes.data(), held.data(), sizeof(Word));
    at_ += sizeof(Word);
    if (swap_) std::ranges::reverse(bytes);
    return std::bit_cast<Word>(bytes);
  }

  InputWindow window_;
  std::uint64_t at_;
  bool swap_;
  const Element* element_ = nullptr;
  std::uint64_t index_ = 0;
};

// The attribute that a property gives to a vertex or face: one of the common ones, or the
// property's own name in quotes.
std::string attribute_of(std::string_view property) {
  struct Known {
    std::string_view attribute, property;
  };
  static constexpr Known kKnown[] = {{kNormals, "nx"},
                                     {kNormals, "ny"},
                                     {kNormals, "nz"},
                                     {kColours, "red"},
                                     {kColours, "green"},
                                     {kColours, "blue"},
                                     {kColours, "alpha"},
                                     {kColours, "diffuse_red"},
                                     {kColours, "diffuse_green"},
                                     {kColours, "diffuse_blue"},
                                     {kTextureCoordinates, "s"},
                                     {kTextureCoordinates, "t"},
                                     {kTextureCoordinates, "u"},
                                     {kTextureCoordinates, "v"},
                                     {kTextureCoordinates, "texture_u"},
                                     {kTextureCoordinates, "texture_v"},
                                     {kTextureCoordinates, "texcoord"},
                                     {kMaterials, "material_index"},
                                     {kMaterials, "texnumber"}};
  for (const Known& known : kKnown) {
    if (known.property == property) return std::string(known.attribute);
  }
  return fmt::format("\"{}\"", printable(property));
}

bool is_corner_list(const Element& element, const Property& property) {
  return (element.name == "face" || element.name == "tristrips") && property.list_count &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

void note_attributes(const PlyHeader& header, FileContent& content) {
  for (const Element& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    if (element.count == 0) continue;
    if (!is_vertex && element.name != "face" && element.name != "tristrips") {
      content.note_attribute(attribute_of(element.name));
      continue;
    }
    for (const Property& p : element.properties) {
      const bool is_shape =
          is_vertex ? p.name == "x" || p.name == "y" || p.name == "z" : is_corner_list(element, p);
      if (!is_shape) content.note_attribute(attribute_of(p.name));
    }
  }
}

// Positions of the three scalars named `names` among the properties; nothing if one is missing.
std::optional<std::array<std::size_t, 3>> find_three(const Element& element,
                                                     const std::array<std::string_view, 3>& names) {
  std::array<std::size_t, 3> positions{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::ranges::find_if(
        element.properties, [&](const Property& p) { return p.name == names[k] && !p.list_count; });
    if (found == element.properties.end()) return std::nullopt;
    positions[k] = static_cast<std::size_t>(found - element.properties.begin());
  }
  return positions;
}

template <class Values>
class Body {
 public:
  Body(const InputStream& input, const PlyHeader& header, FileContent& content)
      : input_(input), header_(header), values_(input, header), content_(content) {}

  void read() {
    const auto is_vertex = [](const Element& e) { return e.name == "vertex"; };
    const auto vertex = std::ranges::find_if(header_.elements, is_vertex);
    const auto coordinates =
        vertex == header_.elements.end() ? std::nullopt : find_three(*vertex, {"x", "y", "z"});
    if (!coordinates) {
      input_.fail("no element \"vertex\" with the properties x, y and z",
                  "export the cloud with coordinates under these names");
    }
    std::uint64_t bytes_left = input_.size() - header_.body + Values::slack();
    for (const Element& element : header_.elements) {
      const std::uint64_t least = least_item_bytes(element);
      if (element.count > 0 && least == 0) {
        input_.fail(fmt::format("element \"{}\" has no properties", printable(element.name)),
                    kExportAgain);
      }
      if (element.count == 0) continue;
      check_count(input_, element.count, fmt::format("\"{}\" elements", printable(element.name)),
                  least, bytes_left);
      bytes_left -= element.count * least;
    }
    for (const Element& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element, *coordinates);
      } else {
        read_element(element, vertex->count);
      }
    }
    values_.end();
    note_attributes(header_, content_);
  }

 private:
  static std::uint64_t least_item_bytes(const Element& element) {
    std::uint64_t bytes = 0;
    for (const Property& p : element.properties)
      bytes += Values::least_bytes(p.list_count.value_or(p.type));
    return bytes;
  }

  std::uint64_t list_length(const Property& property) {
    const std::int64_t length = values_.integer(*property.list_count);
    if (length < 0 || !values_.has_room(property.type, static_cast<std::uint64_t>(length))) {
      values_.fail(fmt::format("a list of {} values does not fit", length));
    }
    return static_cast<std::uint64_t>(length);
  }

  void read_vertices(const Element& element, const std::array<std::size_t, 3>& coordinates) {
    const auto normal =
        content_.points_only() ? std::nullopt : find_three(element, {"nx", "ny", "nz"});
    content_.expect_points(element.count);
    if (normal) content_.normals.reserve(element.count);
    std::vector<double> item(element.properties.size());
    const bool has_lists = std::ranges::any_of(
        element.properties, [](const Property& p) { return p.list_count.has_value(); });
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (Values::kCanPass && !has_lists) {
        if (const std::uint64_t passed = content_.pass_unwanted(element.count - i)) {
          values_.pass(passed * least_item_bytes(element));
          i += passed - 1;
          continue;
        }
      }
      values_.begin_item(element, i);
      for (std::size_t k = 0; k < item.size(); ++k) {
        const Property& property = element.properties[k];
        if (property.list_count) {
          values_.skip(property.type, list_length(property));
        } else {
          item[k] = values_.number(property.type);
        }
      }
      values_.end_item();
      const auto three = [&](const std::array<std::size_t, 3>& at) {
        return Point(item[at[0]], item[at[1]], item[at[2]]);
      };
      content_.add_vertex(three(coordinates), Values::kPlace, values_.place(i));
      if (normal) content_.normals.push_back(three(*normal));
    }
  }

  void read_element(const Element& element, std::uint64_t vertex_count) {
    const bool is_strips = element.name == "tristrips";
    const auto fail = [&](const std::string& what) { values_.fail(what); };
    std::vector<std::int64_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.begin_item(element, i);
      for (const Property& property : element.properties) {
        const std::uint64_t length = property.list_count ? list_length(property) : 1;
        if (!is_corner_list(element, property)) {
          values_.skip(property.type, length);
          continue;
        }
        corners.resize(length);
        for (std::int64_t& corner : corners) corner = values_.integer(property.type);
        if (is_strips) {
          add_strips(content_, corners, vertex_count, fail);
        } else {
          add_polygon(content_, corners, vertex_count, fail);
        }
      }
      values_.end_item();
    }
  }

  const InputStream& input_;
  const PlyHeader& header_;
  Values values_;
  FileContent& content_;
};

}  // namespace

void read_ply(const InputStream& input, FileContent& content) {
  const PlyHeader header = read_ply_header(input);
  header.text ? Body<TextValues>(input, header, content).read()
              : Body<BinaryValues>(input, header, content).read();
}

}  // namespace emax
