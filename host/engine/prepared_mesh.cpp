#include "host/engine/prepared_mesh.h"

#include <numeric>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"

namespace emax {
namespace {

std::size_t blocks_for(std::size_t children) { return (children + kTreeWidth - 1) / kTreeWidth; }

MeshView measurable(MeshView mesh) {
  if (mesh.triangles.empty()) throw Error("the mesh has no triangles to measure a distance to");
  require_no_flush("making triangle frames");
  return mesh;
}

}  // namespace

PreparedMesh::PreparedMesh(MeshView mesh, const Normalization& normalization,
                           const EngineTarget& target, std::size_t threads) {
  std::vector<std::size_t> sizes = {blocks_for(measurable(mesh).triangles.size())};
  while (sizes.back() > 1) sizes.push_back(blocks_for(sizes.back()));
  const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  blocks_ = std::make_unique_for_overwrite<BoxBlock[]>(all);
  std::span<BoxBlock> rest(blocks_.get(), all), below;
  for (const std::size_t size : sizes) {
    const std::span<BoxBlock> level = rest.first(size);
    rest = rest.subspan(size);
    if (levels_.empty()) {
      leaves_ = std::make_shared<MeshLeaves>(mesh, normalization, target, threads, level);
    } else {
      target.make_level(below, level);
    }
    levels_.push_back(level);
    below = level;
  }
}

std::size_t PreparedMesh::memory_bytes() const {
  std::size_t bytes = leaves_->memory_bytes();
  for (const auto level : levels_) bytes += level.size_bytes();
  return bytes;
}

}  // namespace emax
