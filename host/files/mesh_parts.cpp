#include "host/files/mesh_parts.h"

#include <limits>
#include <utility>

#include "host/files/file_content.h"

namespace emax {

MeshParts::MeshParts(const std::filesystem::path& path) : input_(path) {
  input_.require_content();
  const std::string ending = format_ending(path);
  is_stl_ = ending == ".stl";
  if (!is_stl_ && ending != ".ply") return;
  check_ending_fits(input_, input_.head(), ending);
  if (is_stl_) {
    promised_ = stl_triangles_in_parts(input_);
  } else if (const std::optional<PlyCounts> counts = ply_counts_in_parts(input_)) {
    promised_ = counts->faces;
    vertices_ = counts->vertices;
  }
}

std::uint64_t MeshParts::read(std::size_t most, const std::function<void(MeshPart)>& take) const {
  std::uint64_t triangles = 0;
  FileContent content;
  content.take_parts(most, [&](FileContent& c) {
    MeshPart part{take_mesh(input_, c), static_cast<std::uint32_t>(triangles),
                  std::move(c.vertex_numbers)};
    triangles += part.mesh.triangles.size();
    if (triangles > std::numeric_limits<std::uint32_t>::max()) {
      input_.fail("more triangles than 32-bit indices can name", "split the file");
    }
    take(std::move(part));
  });
  if (is_stl_) {
    read_stl_in_parts(input_, content);
  } else {
    read_ply(input_, content);
  }
  return triangles;
}

}  // namespace emax
