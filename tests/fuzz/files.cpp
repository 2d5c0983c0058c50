#include "tests/fuzz/files.h"

#include <algorithm>
#include <exception>
#include <functional>

#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "sw_model/base/error.h"

namespace emax::fuzz {
namespace {

void require_sound(const PointCloud& cloud) {
  const auto is_finite = [](const Point& p) { return p.allFinite(); };
  require(!cloud.points.empty(), "a cloud has points");
  require(std::ranges::all_of(cloud.points, is_finite), "points are finite");
  require(cloud.normals.empty() || cloud.normals.size() == cloud.points.size(),
          "each point has a normal, or none has");
  require(std::ranges::all_of(cloud.normals, is_finite), "normals are finite");
  require(cloud.file_index.empty() || cloud.file_index.size() == cloud.points.size(),
          "each point that is left has its index in the file");
  require(
      std::ranges::adjacent_find(cloud.file_index, std::greater_equal()) == cloud.file_index.end(),
      "indices in the file ascend");
  std::size_t begin = 0;
  for (const ScanPart& scan : cloud.scans) {
    require(begin <= scan.begin && scan.begin <= cloud.points.size(),
            "scans follow each other within the points");
    begin = scan.begin;
  }
  require(cloud.resolution >= 0, "a resolution is a length");
}

void require_sound(const TriangleMesh& mesh) {
  require(!mesh.triangles.empty(), "a mesh has triangles");
  require(std::ranges::all_of(mesh.vertices, [](const Point& p) { return p.allFinite(); }),
          "vertices are finite");
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      require(corner < mesh.vertices.size(), "each corner is a vertex");
    }
  }
}

void require_kept(const TriangleMesh& mesh) {
  for (const std::string_view ending : {".ply", ".obj", ".off"}) {
    const std::string name = "again" + std::string(ending);
    const std::string bytes = mesh_bytes(mesh, mesh_format(name));
    require(mesh_bytes(read_mesh(write(name, bytes_of(bytes))), mesh_format(name)) == bytes,
            "a mesh that was written is read the same");
  }
}

}  // namespace

const test::TemporaryFolder& folder() {
  static const test::TemporaryFolder folder;
  return folder;
}

std::filesystem::path write(std::string_view name, Input bytes) {
  return folder().write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void read_sound_mesh(const std::filesystem::path& path) {
  const TriangleMesh mesh = read_mesh(path);
  require(holds_triangles(path), "a mesh that was read holds triangles");
  require_sound(mesh);
  require_kept(mesh);
}

void read_file(Input bytes, std::string_view ending) {
  const std::filesystem::path path = write("file" + std::string(ending), bytes);
  std::exception_ptr refusal;
  const auto attempt = [&](std::span<const std::string_view> endings, const auto& reader) {
    if (std::ranges::find(endings, ending) == endings.end()) return;
    try {
      reader();
    } catch (const Error&) {
      refusal = std::current_exception();
    }
  };
  attempt(cloud_endings(), [&] { require_sound(read_cloud(path)); });
  attempt(cloud_endings(), [&] { require_sound(read_cloud(path, {.skip_invalid = true})); });
  attempt(mesh_endings(), [&] { read_sound_mesh(path); });
  if (refusal) std::rethrow_exception(refusal);
}

std::string tetrahedron(std::string_view ending) {
  const TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, 0, -2.5e3}},
                             {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  return mesh_bytes(mesh, mesh_format("a" + std::string(ending)));
}

}  // namespace emax::fuzz
