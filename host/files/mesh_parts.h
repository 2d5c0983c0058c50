#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "host/files/input_file.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// Some triangles of a mesh, neighbours in its file, with their vertices alone.
struct MeshPart {
  TriangleMesh mesh;
  std::uint32_t first = 0;  // the number of the first triangle in the mesh
  // Those of the vertices in the mesh. Empty where vertices are equal if their positions are (STL).
  std::vector<std::uint32_t> vertex_numbers;
};

// A mesh in a file, of which a part at a time is in memory. It may be read any number of times.
class MeshParts {
 public:
  // Throws Error where the file or its header is wrong.
  explicit MeshParts(const std::filesystem::path& path);

  // How many triangles the header promises; polygons count once. Nothing where the file has to be
  // held whole. Binary PLY with the vertices before the faces, and binary STL, are read in parts.
  const std::optional<std::uint64_t>& promised() const { return promised_; }
  // How many vertices it has, used or not. Nothing where the triangles repeat them (STL).
  const std::optional<std::uint64_t>& vertices() const { return vertices_; }
  const NamedInput& input() const { return input_; }

  // Gives the triangles that read_mesh_file() gives, in their order, `most` at a time or as many
  // more as the last polygon has. Returns their number. Refuses what read_mesh_file() refuses; a
  // vertex that is not finite only where a triangle uses it. O(n) reading; where the indices of the
  // vertices are without order, all vertices are read for each part.
  std::uint64_t read(std::size_t most, const std::function<void(MeshPart)>& take) const;

 private:
  InputStream input_;
  bool is_stl_;
  std::optional<std::uint64_t> promised_, vertices_;
};

}  // namespace emax
