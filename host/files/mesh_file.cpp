#include "host/files/mesh_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <iterator>

#include "host/files/atomic_file.h"
#include "host/files/file_content.h"
#include "host/files/number_text.h"
#include "host/geometry/merge_vertices.h"
#include "host/geometry/polygon_triangulation.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Reader = FileContent (*)(const InputFile&);

// In the order of MeshFormat.
constexpr std::array<std::string_view, 4> kEndings{".ply", ".obj", ".stl", ".off"};
constexpr std::array<Reader, 4> kReaders{read_ply, read_obj, read_stl, read_off};

template <class Value>
void append(std::string& bytes, const Value& value) {
  static_assert(std::endian::native == std::endian::little);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string ply_bytes(const TriangleMesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  bytes.reserve(bytes.size() + 24 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (const Point& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) append(bytes, v[k]);
  }
  for (const Triangle& t : mesh.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t corner : t) append(bytes, corner);
  }
  return bytes;
}

void append_vertices(std::string& text, const TriangleMesh& mesh, std::string_view before) {
  for (const Point& v : mesh.vertices) {
    text += before;
    for (int k = 0; k < 3; ++k) {
      append_shortest(text, v[k]);
      text += k < 2 ? ' ' : '\n';
    }
  }
}

std::string obj_bytes(const TriangleMesh& mesh) {
  std::string text;
  append_vertices(text, mesh, "v ");
  for (const Triangle& t : mesh.triangles) {
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", std::uint64_t{t[0]} + 1,
                   std::uint64_t{t[1]} + 1, std::uint64_t{t[2]} + 1);
  }
  return text;
}

std::string off_bytes(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  append_vertices(text, mesh, "");
  for (const Triangle& t : mesh.triangles) {
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", t[0], t[1], t[2]);
  }
  return text;
}

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes = "binary STL written by emax";
  bytes.resize(80, ' ');
  bytes.reserve(84 + 50 * mesh.triangles.size());
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Point, 3> corners = mesh.view().corners(t);
    const Point normal =
        (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
    for (const Point& p : {normal, corners[0], corners[1], corners[2]}) {
      for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(p[k]));
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

FileContent read_content(const InputFile& input, const std::filesystem::path& path) {
  const std::size_t format = static_cast<std::size_t>(mesh_format(path));
  check_ending_fits(input, input.bytes, kEndings[format]);
  return kReaders[format](input);
}

// Meshes of depth images have a vertex for every pixel, NaN where nothing was seen. Such a vertex
// belongs to no triangle. It gets the position of one that does, so that the other vertices keep
// their index. Returns false if a triangle has a corner that is not finite.
bool replace_unused_invalid(FileContent& content) {
  const std::vector<bool> used = used_vertices(content.vertices.size(), content.triangles);
  const Point place = content.vertices[content.triangles.front()[0]];
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (content.vertices[v].allFinite()) continue;
    if (used[v]) return false;
    content.vertices[v] = place;
  }
  return true;
}

}  // namespace

std::span<const std::string_view> mesh_endings() { return kEndings; }

MeshFormat mesh_format(const std::filesystem::path& path) {
  const std::string ending = lower_case_ending(path);
  const auto known = std::ranges::find(kEndings, ending);
  if (known == kEndings.end()) {
    throw Error(fmt::format("{}: unknown ending \"{}\"; meshes end in {}", path.string(),
                            printable(ending), fmt::join(kEndings, ", ")));
  }
  return static_cast<MeshFormat>(known - kEndings.begin());
}

TriangleMesh read_mesh(const std::filesystem::path& path) { return read_mesh_file(path).mesh; }

MeshFile read_mesh_file(const std::filesystem::path& path) {
  const InputFile input = read_input(path);
  FileContent content = read_content(input, path);
  if (content.triangles.empty()) {
    input.fail("holds no triangles", "give a mesh, a cloud cannot stand in its place");
  }
  if (!content.first_invalid.empty() && !replace_unused_invalid(content)) {
    input.fail(fmt::format("{}: a coordinate is NaN or infinite", content.first_invalid),
               "mend the mesh, its vertices must be finite");
  }
  for (const auto& [first, count] : content.fans) {
    triangulate(std::span(content.triangles).subspan(first, count), content.vertices);
  }
  return {{std::move(content.vertices), std::move(content.triangles)},
          std::move(content.attributes)};
}

bool holds_triangles(const std::filesystem::path& path) {
  return !read_content(read_input(path), path).triangles.empty();
}

std::string mesh_bytes(const TriangleMesh& mesh, MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return ply_bytes(mesh);
    case MeshFormat::kObj:
      return obj_bytes(mesh);
    case MeshFormat::kStl:
      return stl_bytes(mesh);
    default:
      return off_bytes(mesh);
  }
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  write_atomically(path, mesh_bytes(mesh, mesh_format(path)));
}

Storage storage_of(MeshFormat format) {
  return format == MeshFormat::kStl ? Storage::kBinary32 : Storage::kExact;
}

void require_storable(const TriangleMesh& mesh, MeshFormat format, double epsilon,
                      const std::filesystem::path& path) {
  const double displacement = storage_displacement(mesh, storage_of(format));
  if (displacement > epsilon / 100) {
    throw Error(
        fmt::format("{}: 32-bit STL would move a vertex by {:.3g}, more than a hundredth of "
                    "the maximum error {:.6g}; write .ply, .obj or .off instead",
                    path.string(), displacement, epsilon));
  }
}

}  // namespace emax
