// PLY: the values behind the header, as text or binary.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "host/files/file_content.h"
#include "host/files/ply_header.h"
#include "host/files/text_lines.h"

namespace emax {
namespace {

// The values of a text body: one line for each item, without spare values.
class TextValues {
 public:
  static constexpr std::string_view kPlace = "line";
  static std::size_t least_bytes(PlyType) { return 2; }  // a digit and the byte that ends it
  static std::size_t slack() { return 1; }               // the last digit may end the file

  TextValues(const InputStream& input, const PlyHeader& header)
      : lines_(input, TextLines::Comments::kNone, header.body, header.last_line) {}

  void begin_item(const PlyElement& element, std::uint64_t index) {
    lines_.require_next(element.name, index, element.count);
    field_ = 0;
  }
  double number(PlyType) { return lines_.number(take()); }
  std::int64_t integer(PlyType) { return lines_.integer(take()); }
  void skip(PlyType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) lines_.number(take());
  }
  bool has_room(PlyType, std::uint64_t count) const { return count <= lines_.size() - field_; }
  static constexpr bool kCanPass = false;  // where a line begins is not known
  void pass(std::uint64_t) {}
  std::uint64_t offset() const { return 0; }
  void move_to(std::uint64_t) {}
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
  static std::size_t least_bytes(PlyType type) { return size_of(type); }
  static std::size_t slack() { return 0; }

  BinaryValues(const InputStream& input, const PlyHeader& header)
      : window_(input), at_(header.body), swap_(header.big_endian) {
    static_assert(std::endian::native == std::endian::little);
  }

  void begin_item(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  double number(PlyType type) {
    switch (type) {
      case PlyType::kFloat32:
        return std::bit_cast<float>(take<std::uint32_t>());
      case PlyType::kFloat64:
        return std::bit_cast<double>(take<std::uint64_t>());
      default:
        return static_cast<double>(integer(type));
    }
  }
  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return static_cast<std::int8_t>(take<std::uint8_t>());
      case PlyType::kUint8:
        return take<std::uint8_t>();
      case PlyType::kInt16:
        return static_cast<std::int16_t>(take<std::uint16_t>());
      case PlyType::kUint16:
        return take<std::uint16_t>();
      case PlyType::kInt32:
        return static_cast<std::int32_t>(take<std::uint32_t>());
      case PlyType::kUint32:
        return take<std::uint32_t>();
      default:
        fail(fmt::format("property of {} must be of a whole-number type", element_->name));
    }
  }
  void skip(PlyType type, std::uint64_t count) {
    if (!has_room(type, count)) fail_at_end();
    at_ += count * size_of(type);
  }
  bool has_room(PlyType type, std::uint64_t count) const {
    return count <= (window_.size() - at_) / size_of(type);
  }
  static constexpr bool kCanPass = true;
  void pass(std::uint64_t bytes) { at_ += bytes; }
  std::uint64_t offset() const { return at_; }
  void move_to(std::uint64_t offset) { at_ = offset; }
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
  const PlyElement* element_ = nullptr;
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

bool is_corner_list(const PlyElement& element, const PlyProperty& property) {
  return (element.name == "face" || element.name == "tristrips") && property.list_count &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

void note_attributes(const PlyHeader& header, FileContent& content) {
  for (const PlyElement& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    if (element.count == 0) continue;
    if (!is_vertex && element.name != "face" && element.name != "tristrips") {
      content.note_attribute(attribute_of(element.name));
      continue;
    }
    for (const PlyProperty& p : element.properties) {
      const bool is_shape =
          is_vertex ? p.name == "x" || p.name == "y" || p.name == "z" : is_corner_list(element, p);
      if (!is_shape) content.note_attribute(attribute_of(p.name));
    }
  }
}

// Positions of the three scalars named `names` among the properties; nothing if one is missing.
std::optional<std::array<std::size_t, 3>> find_three(const PlyElement& element,
                                                     const std::array<std::string_view, 3>& names) {
  std::array<std::size_t, 3> positions{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::ranges::find_if(element.properties, [&](const PlyProperty& p) {
      return p.name == names[k] && !p.list_count;
    });
    if (found == element.properties.end()) return std::nullopt;
    positions[k] = static_cast<std::size_t>(found - element.properties.begin());
  }
  return positions;
}

template <class Values>
class Body {
 public:
  Body(const InputStream& input, const PlyHeader& header, FileContent& content)
      : input_(input),
        header_(header),
        values_(input, header),
        places_(input, header),
        content_(content) {}

  void read() {
    const auto is_vertex = [](const PlyElement& e) { return e.name == "vertex"; };
    const auto vertex = std::ranges::find_if(header_.elements, is_vertex);
    const auto coordinates =
        vertex == header_.elements.end() ? std::nullopt : find_three(*vertex, {"x", "y", "z"});
    if (!coordinates) {
      input_.fail("no element \"vertex\" with the properties x, y and z",
                  "export the cloud with coordinates under these names");
    }
    std::uint64_t bytes_left = input_.size() - header_.body + Values::slack();
    for (const PlyElement& element : header_.elements) {
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
    vertex_ = &*vertex;
    coordinates_ = *coordinates;
    for (const PlyElement& element : header_.elements) {
      if (&element != vertex_) {
        read_element(element);
      } else if (content_.is_in_parts()) {
        first_vertex_ = values_.offset();
        values_.pass(element.count * least_item_bytes(element));
      } else {
        read_vertices(element);
      }
    }
    if (content_.is_in_parts()) give_part();
    values_.end();
    note_attributes(header_, content_);
  }

 private:
  static std::uint64_t least_item_bytes(const PlyElement& element) {
    std::uint64_t bytes = 0;
    for (const PlyProperty& p : element.properties)
      bytes += Values::least_bytes(p.list_count.value_or(p.type));
    return bytes;
  }

  std::uint64_t list_length(const PlyProperty& property) {
    const std::int64_t length = values_.integer(*property.list_count);
    if (length < 0 || !values_.has_room(property.type, static_cast<std::uint64_t>(length))) {
      values_.fail(fmt::format("a list of {} values does not fit", length));
    }
    return static_cast<std::uint64_t>(length);
  }

  // Reads the scalars of an item.
  void read_item(Values& values, const PlyElement& element, std::uint64_t index,
                 std::vector<double>& item) {
    values.begin_item(element, index);
    for (std::size_t k = 0; k < item.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (property.list_count) {
        values.skip(property.type, list_length(property));
      } else {
        item[k] = values.number(property.type);
      }
    }
    values.end_item();
  }

  void give_part() {
    read_corners();
    content_.give_part();
  }

  // Reads the vertices of the triangles so far from their places in the file.
  void read_corners() {
    std::vector<std::uint32_t> used;  // ascending
    used.reserve(3 * content_.triangles.size());
    for (const Triangle& t : content_.triangles) used.insert(used.end(), t.begin(), t.end());
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const std::uint64_t bytes = least_item_bytes(*vertex_);
    std::vector<double> item(vertex_->properties.size());
    content_.vertices.reserve(used.size());
    for (const std::uint32_t v : used) {
      places_.move_to(first_vertex_ + v * bytes);
      read_item(places_, *vertex_, v, item);
      content_.add_vertex(three_of(item, coordinates_), Values::kPlace, v);
    }
    for (Triangle& t : content_.triangles) {
      for (std::uint32_t& v : t) {
        v = static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin());
      }
    }
    content_.vertex_numbers = std::move(used);
  }

  static Point three_of(const std::vector<double>& item, const std::array<std::size_t, 3>& at) {
    return {item[at[0]], item[at[1]], item[at[2]]};
  }

  void read_vertices(const PlyElement& element) {
    const auto normal =
        content_.points_only() ? std::nullopt : find_three(element, {"nx", "ny", "nz"});
    content_.expect_points(element.count);
    if (normal) content_.normals.reserve(element.count);
    std::vector<double> item(element.properties.size());
    const bool has_lists = std::ranges::any_of(
        element.properties, [](const PlyProperty& p) { return p.list_count.has_value(); });
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (Values::kCanPass && !has_lists) {
        if (const std::uint64_t passed = content_.pass_unwanted(element.count - i)) {
          values_.pass(passed * least_item_bytes(element));
          i += passed - 1;
          continue;
        }
      }
      read_item(values_, element, i, item);
      content_.add_vertex(three_of(item, coordinates_), Values::kPlace, values_.place(i));
      if (normal) content_.normals.push_back(three_of(item, *normal));
    }
  }

  void read_element(const PlyElement& element) {
    const bool is_strips = element.name == "tristrips";
    const auto fail = [&](const std::string& what) { values_.fail(what); };
    std::vector<std::int64_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.begin_item(element, i);
      for (const PlyProperty& property : element.properties) {
        const std::uint64_t length = property.list_count ? list_length(property) : 1;
        if (!is_corner_list(element, property)) {
          values_.skip(property.type, length);
          continue;
        }
        corners.resize(length);
        for (std::int64_t& corner : corners) corner = values_.integer(property.type);
        if (is_strips) {
          add_strips(content_, corners, vertex_->count, fail);
        } else {
          add_polygon(content_, corners, vertex_->count, fail);
        }
      }
      values_.end_item();
      if (content_.part_is_full()) give_part();
    }
  }

  const InputStream& input_;
  const PlyHeader& header_;
  Values values_;
  Values places_;  // of single vertices
  FileContent& content_;
  const PlyElement* vertex_ = nullptr;
  std::array<std::size_t, 3> coordinates_ = {};
  std::uint64_t first_vertex_ = 0;  // its offset
};

}  // namespace

void read_ply(const InputStream& input, FileContent& content) {
  const PlyHeader header = read_ply_header(input);
  header.text ? Body<TextValues>(input, header, content).read()
              : Body<BinaryValues>(input, header, content).read();
}

}  // namespace emax
