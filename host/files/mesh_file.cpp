#include "host/files/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/files/atomic_file.h"
#include "host/files/file_content.h"
#include "host/files/mesh_writers.h"
#include "host/files/threemf_names.h"
#include "host/geometry/merge_vertices.h"
#include "host/geometry/polygon_triangulation.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Reader = void (*)(const InputStream&, FileContent&);

// In the order of MeshFormat.
constexpr std::array<std::string_view, 7> kMeshEndings{".ply", ".obj", ".stl", ".off",
                                                       ".glb", ".3mf", ".dxf"};
constexpr std::array<Reader, 7> kMeshReaders{read_ply,
                                             read_whole<read_obj>,
                                             read_whole<read_stl>,
                                             read_whole<read_off>,
                                             read_whole<read_glb>,
                                             read_whole<read_threemf>,
                                             read_whole<read_dxf>};

std::optional<MeshFormat> format_with(std::string_view ending) {
  const auto known = std::ranges::find(kMeshEndings, ending);
  if (known == kMeshEndings.end()) return std::nullopt;
  return static_cast<MeshFormat>(known - kMeshEndings.begin());
}

[[noreturn]] void fail_at_ending(const std::filesystem::path& path, std::string_view ending) {
  throw Error(fmt::format("{}: unknown ending \"{}\"; meshes end in {}", path.string(),
                          printable(ending), fmt::join(kMeshEndings, ", ")));
}

FileContent read_content(const InputStream& input, const std::filesystem::path& path) {
  input.require_content();
  const std::string ending = format_ending(path);
  const std::optional<MeshFormat> format = format_with(ending);
  if (!format) fail_at_ending(path, ending);
  check_ending_fits(input, input.head(), ending);
  FileContent content;
  kMeshReaders[static_cast<std::size_t>(*format)](input, content);
  return content;
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

TriangleMesh take_mesh(const NamedInput& input, FileContent& content) {
  if (!content.first_invalid.empty() && !replace_unused_invalid(content)) {
    input.fail(fmt::format("{}: a coordinate is NaN or infinite", content.first_invalid),
               "mend the mesh, its vertices must be finite");
  }
  for (const auto& [first, count] : content.fans) {
    triangulate(std::span(content.triangles).subspan(first, count), content.vertices);
  }
  if (content.repeats_vertices) merge_equal_vertices(content.vertices, content.triangles);
  return {std::move(content.vertices), std::move(content.triangles)};
}

std::span<const std::string_view> mesh_endings() { return kMeshEndings; }

MeshFormat mesh_format(const std::filesystem::path& path) {
  const std::string ending = lower_case_ending(path);
  const std::optional<MeshFormat> format = format_with(ending);
  if (!format) fail_at_ending(path, ending);
  return *format;
}

TriangleMesh read_mesh(const std::filesystem::path& path) { return read_mesh_file(path).mesh; }

MeshFile read_mesh_file(const std::filesystem::path& path) {
  const InputStream input(path);
  FileContent content = read_content(input, path);
  if (content.triangles.empty()) {
    input.fail("holds no triangles", "give a mesh, a cloud cannot stand in its place");
  }
  TriangleMesh mesh = take_mesh(input, content);
  return {std::move(mesh), std::move(content.attributes), content.unit};
}

bool holds_triangles(const std::filesystem::path& path) {
  return !read_content(InputStream(path), path).triangles.empty();
}

std::string mesh_bytes(const TriangleMesh& mesh, MeshFormat format, const MeshNotes& notes) {
  switch (format) {
    case MeshFormat::kPly:
      return ply_bytes(mesh, notes);
    case MeshFormat::kObj:
      return obj_bytes(mesh, notes);
    case MeshFormat::kStl:
      return stl_bytes(mesh);
    case MeshFormat::kGlb:
      return glb_bytes(mesh, notes);
    case MeshFormat::kThreeMf:
      return threemf_bytes(mesh, notes);
    case MeshFormat::kDxf:
      return dxf_bytes(mesh, notes);
    default:
      return off_bytes(mesh);
  }
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                const MeshNotes& notes) {
  require_unit(notes.unit, mesh_format(path), path);
  write_atomically(path, mesh_bytes(mesh, mesh_format(path), notes));
}

void require_unit(const std::optional<Unit>& unit, MeshFormat format,
                  const std::filesystem::path& path) {
  if (format != MeshFormat::kThreeMf || !unit || threemf_unit(*unit)) return;
  throw Error(fmt::format("{}: 3MF has no word for the unit {}; write .glb, .dxf or .ply instead",
                          path.string(), unit->name));
}

Storage storage_of(MeshFormat format) {
  switch (format) {
    case MeshFormat::kStl:
      return Storage::kBinary32;
    case MeshFormat::kGlb:
      return Storage::kShiftedBinary32;
    case MeshFormat::kDxf:
      return Storage::kMerged;
    default:
      return Storage::kExact;
  }
}

void require_storable(const TriangleMesh& mesh, MeshFormat format, double epsilon,
                      const std::filesystem::path& path) {
  const double displacement = storage_displacement(mesh, storage_of(format));
  if (displacement > epsilon / 100) {
    throw Error(fmt::format(
        "{}: the 32 bits of {} would move a vertex by {:.3g}, more than a hundredth of "
        "the maximum error {:.6g}; write .ply, .obj or .off instead",
        path.string(), format == MeshFormat::kStl ? "STL" : "GLB", displacement, epsilon));
  }
}

}  // namespace emax
