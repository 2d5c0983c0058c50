#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/geometry/stored_mesh.h"
#include "host/geometry/triangle_mesh.h"
#include "host/geometry/unit.h"

namespace emax {

enum class MeshFormat { kPly, kObj, kStl, kOff, kGlb, kThreeMf, kDxf };

// The endings of meshes: .ply .obj .stl .off .glb .3mf .dxf.
std::span<const std::string_view> mesh_endings();
// The format by the ending of `path`. Throws Error for another ending.
MeshFormat mesh_format(const std::filesystem::path& path);

// The parts of a mesh, each with a name and a colour.
struct TriangleGroups {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Group {
    std::string name;  // of letters, digits and _
    std::array<std::uint8_t, 3> colour;
  };
  std::vector<std::uint32_t> group_of;  // of each triangle; kNone: none
  std::vector<Group> groups;
};

// What a file holds beside vertices and triangles, where its format has a place for it.
struct MeshNotes {
  std::optional<Unit> unit = {};                       // of the coordinates: GLB, 3MF, DXF
  std::span<const float> deviation = {};               // empty, or a number per vertex: PLY, GLB
  std::span<const float> deviation_of_triangles = {};  // empty, or a number per triangle: PLY
  // PLY: the number of each triangle's group as `region`, -1 for none; OBJ: groups; GLB: a mesh of
  // its name and colour for each. Where triangles of a group follow others, it begins again.
  const TriangleGroups* groups = nullptr;
};

// A mesh, with the names of the other attributes in its file, which the files that we write do not
// keep: "colours", "normals", "texture coordinates", "groups", "materials", or a name from the file
// in quotes.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::string> attributes;
  std::optional<Unit> unit = {};  // nothing where the file does not state it
};
// Reads as read_mesh. The normals of STL follow from the triangles and are not listed.
MeshFile read_mesh_file(const std::filesystem::path& path);

// Reads a triangle mesh as strictly as read_cloud reads clouds. Indices are checked. Polygons are
// cut into fans, or, where they are not convex, into other triangles (polygon_triangulation.h).
// Formats that repeat vertices have those of exactly equal coordinates merged: STL, DXF, and GLB
// where primitives or attributes of vertices are a reason to repeat them. The parts of GLB and 3MF
// files are put in their places, in 64 bits. Throws Error.
TriangleMesh read_mesh(const std::filesystem::path& path);

// Whether a file with the ending of a mesh holds any triangles: .ply, .obj and .off may be clouds.
// Throws Error for a damaged file.
bool holds_triangles(const std::filesystem::path& path);

// The bytes of the file: PLY as binary little endian with 64-bit coordinates; OBJ, OFF, 3MF and DXF
// as text with the shortest digits that read back exactly; STL as binary in 32 bit; GLB as binary
// in 32 bit relative to storage_origin(). Throws Error where the format cannot hold the mesh or has
// no word for the unit.
std::string mesh_bytes(const TriangleMesh& mesh, MeshFormat format, const MeshNotes& notes = {});
// Writes the file whole or not at all. Throws Error.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                const MeshNotes& notes = {});

// Throws Error naming `path` if the format has no word for the unit. Call this before long work.
void require_unit(const std::optional<Unit>& unit, MeshFormat format,
                  const std::filesystem::path& path);

// The storage with which as_stored gives exactly the mesh that read_mesh reads from a file of this
// format.
Storage storage_of(MeshFormat format);

// Throws Error if storing moves a vertex by more than epsilon/100.
void require_storable(const TriangleMesh& mesh, MeshFormat format, double epsilon,
                      const std::filesystem::path& path);

}  // namespace emax
