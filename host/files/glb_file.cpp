// GLB: the scene of a glTF 2.0 file, its nodes put in their places.

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "host/files/copy_limit.h"
#include "host/files/file_content.h"
#include "host/files/glb_container.h"
#include "host/files/glb_layout.h"
#include "host/files/pose.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

enum Mode : std::uint64_t { kPoints = 0, kTriangles = 4, kStrip = 5, kFan = 6 };

Pose placement_of(const GltfObject& node) {
  Pose pose;
  std::array<double, 16> matrix{};
  if (node.numbers("matrix", matrix)) {
    const Eigen::Map<const Eigen::Matrix4d> columns(matrix.data());
    pose.rotation = columns.topLeftCorner<3, 3>();
    pose.shift = columns.topRightCorner<3, 1>();
    return pose;
  }
  std::array<double, 4> turn{0, 0, 0, 1};
  if (node.numbers("rotation", turn)) {
    if (std::ranges::all_of(turn, [](double q) { return q == 0; })) {
      node.fail("\"rotation\" has no length");
    }
    pose.rotation = rotation_of({turn[3], turn[0], turn[1], turn[2]});
  }
  std::array<double, 3> scale{1, 1, 1};
  if (node.numbers("scale", scale)) {
    for (int k = 0; k < 3; ++k) pose.rotation.col(k) *= scale[static_cast<std::size_t>(k)];
  }
  std::array<double, 3> shift{};
  node.numbers("translation", shift);
  pose.shift = {shift[0], shift[1], shift[2]};
  return pose;
}

class Scene {
 public:
  explicit Scene(const InputFile& input)
      : glb_(input), limit_(input), seen_(glb_.size("nodes"), false) {
    limit_.allow(input.bytes.size());
    is_ours_ = glb_.root().object("asset").text("generator") == kGlbGenerator;
  }

  FileContent read() {
    content_.unit = unit_named("m");
    std::vector<std::pair<std::uint64_t, Pose>> open;
    for (const std::uint64_t root : roots()) open.emplace_back(root, frame_or_place(root));
    std::ranges::reverse(open);
    while (!open.empty()) {
      const auto [index, pose] = std::move(open.back());
      open.pop_back();
      const GltfObject node = visit(index);
      if (node.has("mesh")) read_mesh(node, pose);
      std::vector<std::uint64_t> children = node.wholes("children");
      std::ranges::reverse(children);
      for (const std::uint64_t child : children) {
        open.emplace_back(child, pose * placement_of(glb_.element("nodes", child, node.place)));
      }
    }
    if (!is_ours_ && glb_.size("materials") > 0) content_.note_attribute(kMaterials);
    content_.repeats_vertices = primitives_ > 1 || may_repeat_;
    return std::move(content_);
  }

 private:
  // The roots of the scene that is shown, or of all nodes in a file without scenes.
  std::vector<std::uint64_t> roots() const {
    const GltfObject root = glb_.root();
    if (glb_.size("scenes") > 0) {
      return glb_.element("scenes", root.whole("scene", 0), "\"scene\"").wholes("nodes");
    }
    std::vector<bool> is_child(glb_.size("nodes"), false);
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      for (const std::uint64_t child : glb_.element("nodes", i, "").wholes("children")) {
        if (child < is_child.size()) is_child[child] = true;
      }
    }
    std::vector<std::uint64_t> nodes;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) nodes.push_back(i);
    }
    return nodes;
  }

  // The placement of a root. The frame that our writer puts around a mesh leaves the coordinates
  // and gives them their unit.
  Pose frame_or_place(std::uint64_t index) {
    const GltfObject node = glb_.element("nodes", index, "\"scene\"");
    std::array<double, 16> matrix{};
    if (!is_ours_ || !node.has("extras") || !node.numbers("matrix", matrix)) {
      return placement_of(node);
    }
    const GltfObject extras = node.object("extras");
    if (!extras.has(kGlbUnitKey)) return placement_of(node);
    const bool known = !extras.json->at(kGlbUnitKey).is_null();
    const std::optional<Unit> unit = known ? unit_named(extras.text(kGlbUnitKey)) : std::nullopt;
    if ((known && !unit) || matrix != glb_frame(unit)) return placement_of(node);
    content_.unit = unit;
    return {};
  }

  // A node has one parent, so that no node is read twice and none contains itself.
  GltfObject visit(std::uint64_t index) {
    GltfObject node = glb_.element("nodes", index, "a node");
    if (seen_[index]) node.fail("has two parents, or contains itself");
    seen_[index] = true;
    if (node.has("skin")) node.fail("is moved by a skin", "export the mesh in its final shape");
    return node;
  }

  void read_mesh(const GltfObject& node, const Pose& pose) {
    const GltfObject mesh = glb_.element("meshes", node.required("mesh"), node.place);
    if (mesh.has("weights") || node.has("weights")) content_.note_attribute("morph targets");
    for (const GltfObject& primitive : mesh.objects("primitives")) read(primitive, pose);
  }

  void read(const GltfObject& primitive, const Pose& pose) {
    const std::uint64_t mode = primitive.whole("mode", kTriangles);
    if (mode > kFan) primitive.fail(fmt::format("no such mode {}", mode));
    if (mode != kPoints && mode < kTriangles) {
      content_.note_attribute("lines");
      return;
    }
    const GltfObject attributes = primitive.object("attributes");
    note(attributes);
    const std::optional<std::uint64_t> position = attributes.whole("POSITION");
    if (!position) return;  // the specification lets a reader pass over it
    const GltfAccessor vertices = glb_.accessor(*position, "VEC3", primitive.place);
    const std::size_t first = add_vertices(vertices, *position, pose);
    if (mode == kPoints) return;
    if (!primitive.has("indices")) may_repeat_ = true;
    const std::vector<std::uint32_t> corners = corners_of(primitive, vertices.size());
    if (mode == kTriangles && corners.size() % 3 != 0) {
      primitive.fail(fmt::format("{} corners are not whole triangles", corners.size()));
    }
    add_triangles(corners, mode, static_cast<std::uint32_t>(first),
                  pose.rotation.determinant() < 0);
  }

  // The number of the first of them. Vertices that another part of our file has at the same place
  // are added once: our writer gives all parts the vertices of the whole.
  std::size_t add_vertices(const GltfAccessor& vertices, std::uint64_t accessor, const Pose& pose) {
    if (is_ours_ && added_ && added_->accessor == accessor &&
        added_->pose.rotation == pose.rotation && added_->pose.shift == pose.shift) {
      return added_->first;
    }
    limit_.spend(vertices.size());
    added_ = {accessor, pose, content_.vertices.size()};
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      content_.add_vertex(
          pose({vertices.number(v, 0), vertices.number(v, 1), vertices.number(v, 2)}), "vertex",
          content_.vertices.size());
    }
    ++primitives_;
    return added_->first;
  }

  std::vector<std::uint32_t> corners_of(const GltfObject& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> corners;
    if (!primitive.has("indices")) {
      for (std::uint32_t v = 0; v < vertices; ++v) corners.push_back(v);
      return corners;
    }
    const GltfAccessor indices =
        glb_.accessor(primitive.required("indices"), "SCALAR", primitive.place);
    limit_.spend(indices.size());
    corners.reserve(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
      corners.push_back(indices.index(i));
      if (corners.back() >= vertices && !EMAX_FAULT(kTrustsIndices)) {
        primitive.fail(
            fmt::format("vertex index {} is outside 0..{} - 1", corners.back(), vertices),
            kExportAgain);
      }
    }
    return corners;
  }

  void add_triangles(std::span<const std::uint32_t> corners, std::uint64_t mode,
                     std::uint32_t first, bool mirrored) {
    const std::size_t step = mode == kTriangles ? 3 : 1;
    for (std::size_t i = 0; i + 3 <= corners.size(); i += step) {
      Triangle t = {first + corners[mode == kFan ? 0 : i], first + corners[i + 1],
                    first + corners[i + 2]};
      const bool turned = mode == kStrip && i % 2 != 0;
      if (turned != mirrored) std::swap(t[1], t[2]);
      const bool is_stitch = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      if (mode != kStrip || !is_stitch) content_.triangles.push_back(t);
    }
  }

  // Attributes that differ from triangle to triangle are a reason to repeat vertices.
  void note(const GltfObject& attributes) {
    for (const auto& [name, accessor] : attributes.json->items()) {
      if (name == "POSITION") continue;
      if (!name.starts_with('_')) may_repeat_ = true;
      content_.note_attribute(name == "NORMAL"                ? std::string(kNormals)
                              : name.starts_with("TEXCOORD_") ? std::string(kTextureCoordinates)
                              : name.starts_with("COLOR_")
                                  ? std::string(kColours)
                                  : fmt::format("\"{}\"", printable(name)));
    }
  }

  GlbContainer glb_;
  CopyLimit limit_;
  std::vector<bool> seen_;  // of the nodes
  FileContent content_;
  struct AddedVertices {
    std::uint64_t accessor;
    Pose pose;
    std::size_t first;
  };
  std::optional<AddedVertices> added_;  // last
  std::size_t primitives_ = 0;
  bool may_repeat_ = false;
  bool is_ours_ = false;  // our writer made the file
};

}  // namespace

FileContent read_glb(const InputFile& input) { return Scene(input).read(); }

}  // namespace emax
