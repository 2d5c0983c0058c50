#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/geometry/stored_mesh.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

enum class MeshFormat { kPly, kObj, kStl, kOff };

// The endings of meshes: .ply .obj .stl .off.
std::span<const std::string_view> mesh_endings();
// By the ending of `path`. Throws Error for another one.
MeshFormat mesh_format(const std::filesystem::path& path);

// A mesh, and by name what else its file says of it, which no file of ours keeps: "colours",
// "normals", "texture coordinates", "groups", "materials", or a name of the file's in quotes.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::string> attributes;
};
// As read_mesh. The normals of STL say nothing that the triangles do not, and are not named.
MeshFile read_mesh_file(const std::filesystem::path& path);

// Reads a triangle mesh as strictly as read_cloud reads clouds; indices are checked, polygons cut
// into fans, or where they are not convex into other triangles (polygon_triangulation.h). STL
// repeats its vertices: those of exactly equal coordinates are merged. Throws Error.
TriangleMesh read_mesh(const std::filesystem::path& path);

// Whether the file, of one of the endings of meshes, holds any triangles: .ply, .obj and .off may
// be clouds. Throws Error for a damaged one.
bool holds_triangles(const std::filesystem::path& path);

// The bytes of the file: PLY as binary little endian with 64-bit coordinates, OBJ and OFF as text
// with the shortest digits that read back exactly, STL as binary in 32 bit.
std::string mesh_bytes(const TriangleMesh& mesh, MeshFormat format);
// Writes them whole or not at all. Throws Error.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

// What as_stored needs to give exactly what read_mesh gives back from a file of this format.
Storage storage_of(MeshFormat format);

// Throws Error when storing moves a vertex by more than epsilon/100.
void require_storable(const TriangleMesh& mesh, MeshFormat format, double epsilon,
                      const std::filesystem::path& path);

}  // namespace emax
