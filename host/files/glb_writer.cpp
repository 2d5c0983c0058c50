// glTF 2.0 binary (GLB): a chunk of JSON that describes a chunk of vertices and indices.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/files/append_value.h"
#include "host/files/glb_layout.h"
#include "host/files/mesh_writers.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kTargetVertices = 34962, kTargetIndices = 34963;  // ARRAY_BUFFER and so on
constexpr int kPointsMode = 0;                                  // of a primitive

OrderedJson xyz(const Point& p) { return {p.x(), p.y(), p.z()}; }

// The binary chunk, and in `json` the views and accessors of its parts.
class Arrays {
 public:
  // `count` elements of `type` that `append` adds to the bytes. Returns the accessor's index.
  template <class Append>
  std::size_t add(int component, const char* type, std::size_t count, std::optional<int> target,
                  const Append& append) {
    const std::size_t begin = bytes.size();
    append();
    OrderedJson view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size() - begin}};
    if (target) view["target"] = *target;
    views.push_back(std::move(view));
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", component},
                         {"count", count},
                         {"type", type}});
    return accessors.size() - 1;
  }

  std::string bytes;
  OrderedJson views = OrderedJson::array(), accessors = OrderedJson::array();
};

std::size_t add_positions(std::span<const Point> points, const Point& origin, Arrays& arrays) {
  Point lower = Point::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  const std::size_t position = arrays.add(kGltfFloat, "VEC3", points.size(), kTargetVertices, [&] {
    for (const Point& point : points) {
      for (int k = 0; k < 3; ++k) {
        const volatile float rounded = static_cast<float>(point[k] - origin[k]);
        const float relative = rounded;
        append_value(arrays.bytes, relative);
        lower[k] = std::min(lower[k], static_cast<double>(relative));
        upper[k] = std::max(upper[k], static_cast<double>(relative));
      }
    }
  });
  arrays.accessors[position]["min"] = xyz(lower);
  arrays.accessors[position]["max"] = xyz(upper);
  return position;
}

std::size_t add_indices(std::span<const Triangle> triangles, Arrays& arrays) {
  return arrays.add(kGltfUint32, "SCALAR", 3 * triangles.size(), kTargetIndices, [&] {
    for (const Triangle& t : triangles) {
      for (const std::uint32_t corner : t) append_value(arrays.bytes, corner);
    }
  });
}

OrderedJson primitive_of(const TriangleMesh& mesh, const MeshNotes& notes, const Point& origin,
                         Arrays& arrays) {
  const std::size_t position = add_positions(mesh.vertices, origin, arrays);
  OrderedJson primitive = {{"attributes", {{"POSITION", position}}}, {"material", 0}};
  if (!notes.deviation.empty()) {
    primitive["attributes"]["_DEVIATION"] =
        arrays.add(kGltfFloat, "SCALAR", mesh.vertices.size(), kTargetVertices, [&] {
          for (const float value : notes.deviation) append_value(arrays.bytes, value);
        });
  }
  if (mesh.triangles.empty()) {
    primitive["mode"] = kPointsMode;
    return primitive;
  }
  primitive["indices"] = add_indices(mesh.triangles, arrays);
  return primitive;
}

void append_chunk(std::string& bytes, std::uint32_t type, std::string_view content, char filler) {
  const std::size_t padding = (4 - content.size() % 4) % 4;
  append_value(bytes, static_cast<std::uint32_t>(content.size() + padding));
  append_value(bytes, type);
  bytes += content;
  bytes.append(padding, filler);
}

// The frame with `nodes` below it, which have the numbers from 1 on.
OrderedJson scene_of(const std::optional<Unit>& unit, OrderedJson nodes) {
  OrderedJson frame = {{"name", "frame"}, {"matrix", glb_frame(unit)}};
  frame["children"] = OrderedJson::array();
  for (std::size_t i = 1; i <= nodes.size(); ++i) frame["children"].push_back(i);
  frame["extras"][kGlbUnitKey] = unit ? OrderedJson(unit->name) : OrderedJson(nullptr);
  OrderedJson json = {{"asset", {{"version", "2.0"}, {"generator", kGlbGenerator}}}, {"scene", 0}};
  OrderedJson scene;
  scene["nodes"] = OrderedJson::array({0});
  json["scenes"] = OrderedJson::array({std::move(scene)});
  json["nodes"] = OrderedJson::array({std::move(frame)});
  for (OrderedJson& node : nodes) json["nodes"].push_back(std::move(node));
  return json;
}

void set_arrays(OrderedJson& json, Arrays& arrays) {
  json["accessors"] = std::move(arrays.accessors);
  json["bufferViews"] = std::move(arrays.views);
  OrderedJson buffer;
  buffer["byteLength"] = arrays.bytes.size();
  json["buffers"] = OrderedJson::array({std::move(buffer)});
}

// Without a material, a mesh is metal that is seen from outside only.
OrderedJson material() {
  return {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.8}}},
          {"doubleSided", true}};
}

OrderedJson material(const std::array<std::uint8_t, 3>& colour) {
  OrderedJson look = material();
  OrderedJson factor = OrderedJson::array();
  for (const std::uint8_t c : colour) factor.push_back(c / 255.0);
  factor.push_back(1);
  look["pbrMetallicRoughness"]["baseColorFactor"] = std::move(factor);
  return look;
}

std::string container(const OrderedJson& json, const std::string& binary) {
  std::string bytes(kGlbMagic);
  append_value(bytes, kGlbVersion);
  append_value(bytes, std::uint32_t{0});  // the length, once it is known
  append_chunk(bytes, kGlbJson, json.dump(), ' ');
  if (!binary.empty()) append_chunk(bytes, kGlbBinary, binary, '\0');
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("a GLB file of {} bytes cannot be: it holds 4 GiB at most; write .ply",
                            bytes.size()));
  }
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::copy_n(reinterpret_cast<const char*>(&length), sizeof length, bytes.begin() + 8);
  return bytes;
}

// A mesh of triangles for each run of a group. All have the same vertices.
std::string glb_of_parts(const TriangleMesh& mesh, const MeshNotes& notes) {
  const Point origin = storage_origin(mesh.vertices);
  OrderedJson nodes = OrderedJson::array(), meshes = OrderedJson::array(),
              materials = OrderedJson::array();
  Arrays arrays;
  const OrderedJson whole = primitive_of({mesh.vertices, {}}, notes, origin, arrays);
  for (const auto& [group, begin, end] : group_runs(*notes.groups)) {
    const std::string name(name_of(*notes.groups, group));
    OrderedJson primitive = {
        {"attributes", whole["attributes"]},
        {"material", materials.size()},
        {"indices", add_indices(std::span(mesh.triangles).subspan(begin, end - begin), arrays)}};
    nodes.push_back({{"name", name}, {"translation", xyz(origin)}, {"mesh", meshes.size()}});
    OrderedJson part = {{"name", name}};
    part["primitives"] = OrderedJson::array({std::move(primitive)});
    meshes.push_back(std::move(part));
    materials.push_back(
        group == TriangleGroups::kNone ? material() : material(notes.groups->groups[group].colour));
  }
  OrderedJson json = scene_of(notes.unit, std::move(nodes));
  json["meshes"] = std::move(meshes);
  json["materials"] = std::move(materials);
  set_arrays(json, arrays);
  return container(json, arrays.bytes);
}

}  // namespace

std::string glb_bytes(const TriangleMesh& mesh, const MeshNotes& notes) {
  if (notes.groups != nullptr && !mesh.triangles.empty()) return glb_of_parts(mesh, notes);
  const Point origin = storage_origin(mesh.vertices);
  OrderedJson node = {{"name", "mesh"}, {"translation", xyz(origin)}};
  if (!mesh.vertices.empty()) node["mesh"] = 0;
  OrderedJson json = scene_of(notes.unit, OrderedJson::array({std::move(node)}));
  Arrays arrays;
  if (!mesh.vertices.empty()) {
    OrderedJson whole;
    whole["primitives"] = OrderedJson::array({primitive_of(mesh, notes, origin, arrays)});
    json["meshes"] = OrderedJson::array({std::move(whole)});
    json["materials"] = OrderedJson::array({material()});
    set_arrays(json, arrays);
  }
  return container(json, arrays.bytes);
}

std::string glb_of_groups(const PointGroups& groups) {
  const Point origin = storage_origin(groups.points);
  const auto members = members_of(groups);
  OrderedJson nodes = OrderedJson::array(), meshes = OrderedJson::array(),
              materials = OrderedJson::array();
  Arrays arrays;
  for (std::size_t g = 0; g < members.size(); ++g) {
    if (members[g].empty()) continue;
    const bool none = g == groups.groups.size();
    const std::string name = none ? "none" : groups.groups[g].name;
    const auto colour = none ? kColourOfNone : groups.groups[g].colour;
    std::vector<Point> points;
    for (const std::uint32_t i : members[g]) points.push_back(groups.points[i]);
    nodes.push_back({{"name", name}, {"translation", xyz(origin)}, {"mesh", meshes.size()}});
    OrderedJson primitive = {{"attributes", {{"POSITION", add_positions(points, origin, arrays)}}},
                             {"material", materials.size()},
                             {"mode", kPointsMode}};
    OrderedJson mesh = {{"name", name}};
    mesh["primitives"] = OrderedJson::array({std::move(primitive)});
    meshes.push_back(std::move(mesh));
    materials.push_back(material(colour));
  }
  OrderedJson json = scene_of(groups.unit, std::move(nodes));
  if (!groups.points.empty()) {
    json["meshes"] = std::move(meshes);
    json["materials"] = std::move(materials);
    set_arrays(json, arrays);
  }
  return container(json, arrays.bytes);
}

}  // namespace emax
