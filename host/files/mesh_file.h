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
// The format by the ending of `path`. Throws Error for another ending.
MeshFormat mesh_format(const std::filesystem::path& path);

// A mesh, with the names of the other attributes in its file, which the files that we write do not
// keep: "colours", "normals", "texture coordinates", "groups", "materials", or a name from the file
// in quotes.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::string> attributes;
};
// Reads as read_mesh. The normals of STL follow from the triangles and are not listed.
MeshFile read_mesh_file(const std::filesystem::path& path);

// Reads a triangle mesh as strictly as read_cloud reads clouds. Indices are checked. Polygons are
// cut into fans, or, where they are not convex, into other triangles (polygon_triangulation.h). STL
// repeats its vertices; vertices of exactly equal coordinates are merged. Throws Error.
TriangleMesh read_mesh(const std::filesystem::path& path);

// Whether a file with the ending of a mesh holds any triangles: .ply, .obj and .off may be clouds.
// Throws Error for a damaged file.
bool holds_triangles(const std::filesystem::path& path);

// The bytes of the file: PLY as binary little endian with 64-bit coordinates, OBJ and OFF as text
// with the shortest digits that read back exactly, STL as binary in 32 bit.
std::string mesh_bytes(const TriangleMesh& mesh, MeshFormat format);
// Writes the file whole or not at all. Throws Error.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

// The storage with which as_stored gives exactly the mesh that read_mesh reads from a file of this
// format.
Storage storage_of(MeshFormat format);

// Throws Error if storing moves a vertex by more than epsilon/100.
void require_storable(const TriangleMesh& mesh, MeshFormat format, double epsilon,
                      const std::filesystem::path& path);

}  // namespace emax
