#include "host/files/glb_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>

#include "host/files/file_content.h"
#include "host/files/glb_layout.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHeaderBytes = 12, kChunkBytes = 8;
// Parsed JSON takes many times its bytes, and the JSON of a mesh is short.
constexpr std::size_t kMostJson = std::size_t{64} << 20;
constexpr std::uint64_t kGreatestWhole = std::uint64_t{1} << 53;

// Of extensions that change materials, lights and the like, and of the one that stores coordinates
// as whole numbers, which need nothing of their reader.
bool leaves_shapes(std::string_view extension) {
  return extension == "KHR_mesh_quantization" || extension == "KHR_texture_transform" ||
         extension == "KHR_texture_basisu" || extension == "EXT_texture_webp" ||
         extension == "KHR_lights_punctual" || extension.starts_with("KHR_materials_");
}

std::size_t component_bytes(int type) {
  switch (type) {
    case kGltfInt8:
    case kGltfUint8:
      return 1;
    case kGltfInt16:
    case kGltfUint16:
      return 2;
    case kGltfUint32:
    case kGltfFloat:
      return 4;
    default:
      return 0;
  }
}

template <class Value>
Value loaded(const char* from) {
  Value value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// The whole numbers that a normalized accessor holds stand for shares of the greatest.
template <class Whole>
double whole_number(const char* from, bool normalized) {
  const double value = loaded<Whole>(from);
  if (!normalized) return value;
  return std::max(value / static_cast<double>(std::numeric_limits<Whole>::max()), -1.0);
}

}  // namespace

void GltfObject::fail(std::string_view what) const { fail(what, "export it again"); }

void GltfObject::fail(std::string_view what, std::string_view remedy) const {
  input->fail(fmt::format("{}: {}", place, what), remedy);
}

std::optional<std::uint64_t> GltfObject::whole(const char* key) const {
  const auto member = json->find(key);
  if (member == json->end()) return std::nullopt;
  if (!member->is_number_unsigned() || member->get<std::uint64_t>() >= kGreatestWhole) {
    fail(fmt::format("\"{}\" is not a whole number from 0", key));
  }
  return member->get<std::uint64_t>();
}

std::uint64_t GltfObject::whole(const char* key, std::uint64_t otherwise) const {
  return whole(key).value_or(otherwise);
}

std::uint64_t GltfObject::required(const char* key) const {
  const std::optional<std::uint64_t> value = whole(key);
  if (!value) fail(fmt::format("\"{}\" is missing", key));
  return *value;
}

std::string GltfObject::text(const char* key) const {
  const auto member = json->find(key);
  if (member == json->end()) return {};
  if (!member->is_string()) fail(fmt::format("\"{}\" is not a text", key));
  return member->get<std::string>();
}

bool GltfObject::numbers(const char* key, std::span<double> to) const {
  const auto member = json->find(key);
  if (member == json->end()) return false;
  const bool fits = member->is_array() && member->size() == to.size() &&
                    std::ranges::all_of(*member, [](const Json& n) { return n.is_number(); });
  if (!fits) fail(fmt::format("\"{}\" is not a list of {} numbers", key, to.size()));
  std::ranges::transform(*member, to.begin(), [](const Json& n) { return n.get<double>(); });
  return true;
}

std::vector<std::uint64_t> GltfObject::wholes(const char* key) const {
  const auto member = json->find(key);
  if (member == json->end()) return {};
  const bool fits = member->is_array() && std::ranges::all_of(*member, [](const Json& n) {
                      return n.is_number_unsigned();
                    });
  if (!fits) fail(fmt::format("\"{}\" is not a list of whole numbers", key));
  return member->get<std::vector<std::uint64_t>>();
}

std::vector<std::string> GltfObject::texts(const char* key) const {
  const auto member = json->find(key);
  if (member == json->end()) return {};
  const bool fits = member->is_array() &&
                    std::ranges::all_of(*member, [](const Json& t) { return t.is_string(); });
  if (!fits) fail(fmt::format("\"{}\" is not a list of texts", key));
  return member->get<std::vector<std::string>>();
}

std::vector<GltfObject> GltfObject::objects(const char* key) const {
  const auto member = json->find(key);
  if (member == json->end()) return {};
  const bool fits = member->is_array() &&
                    std::ranges::all_of(*member, [](const Json& o) { return o.is_object(); });
  if (!fits) fail(fmt::format("\"{}\" is not a list of objects", key));
  std::vector<GltfObject> list;
  for (const Json& object : *member) {
    list.push_back({input, &object, fmt::format("{}, {} {}", place, key, list.size())});
  }
  return list;
}

GltfObject GltfObject::object(const char* key) const {
  static const Json empty = Json::object();
  const auto member = json->find(key);
  if (member == json->end()) return {input, &empty, place};
  if (!member->is_object()) fail(fmt::format("\"{}\" is not an object", key));
  return {input, &*member, fmt::format("{}, \"{}\"", place, key)};
}

double GltfAccessor::number(std::size_t element, std::size_t component) const {
  const char* const from = data_ + element * stride_ + component * component_bytes(component_);
  switch (component_) {
    case kGltfInt8:
      return whole_number<std::int8_t>(from, normalized_);
    case kGltfUint8:
      return whole_number<std::uint8_t>(from, normalized_);
    case kGltfInt16:
      return whole_number<std::int16_t>(from, normalized_);
    case kGltfUint16:
      return whole_number<std::uint16_t>(from, normalized_);
    case kGltfUint32:
      return whole_number<std::uint32_t>(from, normalized_);
    default:
      return static_cast<double>(loaded<float>(from));
  }
}

std::uint32_t GltfAccessor::index(std::size_t element) const {
  const char* const from = data_ + element * stride_;
  switch (component_) {
    case kGltfUint8:
      return loaded<std::uint8_t>(from);
    case kGltfUint16:
      return loaded<std::uint16_t>(from);
    default:
      return loaded<std::uint32_t>(from);
  }
}

GlbContainer::GlbContainer(const InputFile& input) : input_(input) {
  find_chunks();
  try {
    json_ = Json::parse(text_);
  } catch (const Json::exception&) {
    input_.fail("its JSON cannot be parsed", kExportAgain);
  }
  if (!json_.is_object()) input_.fail("its JSON is not an object", "export it again");
  check_version();
  check_extensions();
}

void GlbContainer::find_chunks() {
  const std::string_view bytes = input_.bytes;
  if (!bytes.starts_with(kGlbMagic)) {
    input_.fail("does not begin with \"glTF\"", "it is no GLB file, give it its own ending");
  }
  if (bytes.size() < kHeaderBytes) input_.fail("the file ends in its header", kExportAgain);
  const auto word = [&](std::size_t at) { return loaded<std::uint32_t>(bytes.data() + at); };
  if (word(4) != kGlbVersion) {
    input_.fail(fmt::format("version {} of GLB", word(4)), "export it as glTF 2.0");
  }
  if (word(8) != bytes.size()) {
    input_.fail(
        fmt::format("the header promises {} bytes, but the file has {}", word(8), bytes.size()),
        kExportAgain);
  }
  for (std::size_t at = kHeaderBytes, chunk = 0; at < bytes.size(); ++chunk) {
    const std::size_t left = bytes.size() - at;
    if (left < kChunkBytes || (!EMAX_FAULT(kTrustsCounts) && word(at) > left - kChunkBytes)) {
      input_.fail(fmt::format("chunk {} ends behind the file", chunk), kExportAgain);
    }
    const std::string_view content(bytes.data() + at + kChunkBytes, word(at));
    const std::uint32_t type = word(at + 4);
    if (chunk == 0 && type == kGlbJson) text_ = content;
    if (chunk == 1 && type == kGlbBinary) binary_ = content;
    at += kChunkBytes + content.size();
  }
  if (text_.empty()) input_.fail("its first chunk is not JSON", kExportAgain);
  if (text_.size() > kMostJson) {
    input_.fail(fmt::format("its JSON has {} bytes, more than {}", text_.size(), kMostJson),
                "export the mesh alone");
  }
}

void GlbContainer::check_version() const {
  const std::string version = root().object("asset").text("version");
  if (!version.starts_with("2.")) {
    input_.fail(fmt::format("version \"{}\" of glTF", printable(version)), "export it as glTF 2.0");
  }
}

void GlbContainer::check_extensions() const {
  for (const std::string& extension : root().texts("extensionsRequired")) {
    if (leaves_shapes(extension)) continue;
    const bool compresses = extension == "KHR_draco_mesh_compression" ||
                            extension == "EXT_meshopt_compression" ||
                            extension == "KHR_meshopt_compression";
    input_.fail(
        fmt::format("it needs the extension {}, which emax does not read", printable(extension)),
        compresses ? "export it without compression of its meshes"
                   : "export it without this extension");
  }
}

std::size_t GlbContainer::size(const char* list) const {
  const auto member = json_.find(list);
  return member == json_.end() || !member->is_array() ? 0 : member->size();
}

GltfObject GlbContainer::element(const char* list, std::uint64_t index,
                                 std::string_view user) const {
  if (index >= size(list)) {
    input_.fail(fmt::format("{} refers to {} {}, and there are {}", user, list, index, size(list)),
                kExportAgain);
  }
  const Json& json = json_.at(list)[index];
  GltfObject object{&input_, &json, fmt::format("{} {}", list, index)};
  if (!json.is_object()) object.fail("is not an object");
  return object;
}

std::string_view GlbContainer::view_bytes(const GltfObject& view) const {
  const std::uint64_t index = view.required("buffer");
  const GltfObject buffer = element("buffers", index, view.place);
  if (index != 0 || buffer.has("uri") || binary_.empty()) {
    view.fail("its buffer is not in the file", "export it as one .glb file");
  }
  const std::uint64_t length = buffer.required("byteLength");
  if (length > binary_.size()) {
    buffer.fail(fmt::format("{} bytes are promised, {} are there", length, binary_.size()),
                kExportAgain);
  }
  const std::uint64_t offset = view.whole("byteOffset", 0), bytes = view.required("byteLength");
  if (offset > length || bytes > length - offset) {
    view.fail(fmt::format("ends behind its buffer of {} bytes", length), kExportAgain);
  }
  return binary_.substr(offset, bytes);
}

GltfAccessor GlbContainer::accessor(std::uint64_t index, std::string_view type,
                                    std::string_view user) const {
  const GltfObject object = element("accessors", index, user);
  if (object.text("type") != type) object.fail(fmt::format("is not of type {}", type));
  if (object.has("sparse")) object.fail("is sparse", "export it without sparse accessors");
  if (!object.has("bufferView")) object.fail("has no buffer view");
  const GltfObject view = element("bufferViews", object.required("bufferView"), object.place);
  const std::string_view bytes = view_bytes(view);

  GltfAccessor accessor;
  accessor.component_ = static_cast<int>(object.required("componentType"));
  const std::size_t component = component_bytes(accessor.component_);
  const bool is_index = accessor.component_ == kGltfUint8 || accessor.component_ == kGltfUint16 ||
                        accessor.component_ == kGltfUint32;
  if (component == 0 || (type == "SCALAR" && !is_index)) {
    object.fail(fmt::format("componentType {} cannot stand here", accessor.component_));
  }
  accessor.normalized_ = object.json->value("normalized", Json(false)) == Json(true);
  const std::size_t element_bytes = component * (type == "VEC3" ? 3 : 1);
  accessor.stride_ = view.whole("byteStride", element_bytes);
  if (accessor.stride_ < element_bytes || accessor.stride_ > 252) {
    view.fail(
        fmt::format("a stride of {} bytes for elements of {}", accessor.stride_, element_bytes));
  }
  const std::uint64_t offset = object.whole("byteOffset", 0);
  accessor.count_ = object.required("count");
  const bool fits =
      offset <= bytes.size() && bytes.size() - offset >= element_bytes &&
      accessor.count_ <= (bytes.size() - offset - element_bytes) / accessor.stride_ + 1;
  if (!fits && accessor.count_ > 0) {
    object.fail(fmt::format("{} elements from byte {} are promised, but its view has {} bytes",
                            accessor.count_, offset, bytes.size()),
                kExportAgain);
  }
  accessor.data_ = bytes.data() + std::min<std::size_t>(offset, bytes.size());
  return accessor;
}

}  // namespace emax
