#include "host/emax_search/prepared_mesh.h"

#include <algorithm>
#include <numeric>

#include "host/emax_search/parallel.h"
#include "sw_model/error.h"
#include "sw_model/flush_mode.h"

namespace emax {
namespace {

constexpr std::size_t kPiece = 4096;  // triangles
static_assert(kPiece % kTreeWidth == 0);

std::size_t pieces_of(std::size_t count, std::size_t size) { return (count + size - 1) / size; }

MeshView measurable(MeshView mesh) {
  if (mesh.triangles.empty()) throw Error("the mesh has no triangles to measure a distance to");
  require_no_flush("making triangle frames");
  return mesh;
}

}  // namespace

PreparedMesh::PreparedMesh(MeshView mesh, const Normalization& normalization,
                           const EngineTarget& target, std::size_t threads)
    : leaves_(std::make_shared<MeshLeaves>(measurable(mesh), normalization, threads)),
      triangles_(mesh.triangles.size()) {
  std::vector<std::size_t> sizes = {pieces_of(triangles_, kTreeWidth)};
  while (sizes.back() > 1) sizes.push_back(pieces_of(sizes.back(), kTreeWidth));
  const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  records_ = std::make_unique_for_overwrite<TriangleRecord<float>[]>(triangles_);
  blocks_ = std::make_unique_for_overwrite<BoxBlock[]>(all);
  const std::span<TriangleRecord<float>> records(records_.get(), triangles_);
  std::span<BoxBlock> rest(blocks_.get(), all), below;
  for (const std::size_t size : sizes) {
    const std::span<BoxBlock> level = rest.first(size);
    rest = rest.subspan(size);
    if (levels_.empty()) {
      std::vector<float> reach(pieces_of(triangles_, kPiece));
      in_pieces(threads, triangles_, kPiece, [&](std::size_t, std::size_t first, std::size_t last) {
        const std::size_t count = last - first;
        reach[first / kPiece] =
            target.make_leaves(leaves_->vertices(), leaves_->corners().subspan(first, count),
                               leaves_->keys().subspan(first, count), records.subspan(first, count),
                               level.subspan(first / kTreeWidth, pieces_of(count, kTreeWidth)));
      });
      reach_ = *std::ranges::max_element(reach);
    } else {
      target.make_level(below, level);
    }
    levels_.push_back(level);
    below = level;
  }
}

std::size_t PreparedMesh::memory_bytes() const {
  std::size_t bytes = records().size_bytes() + leaves_->vertices().size_bytes() +
                      leaves_->keys().size_bytes() + leaves_->corners().size_bytes();
  for (const auto level : levels_) bytes += level.size_bytes();
  return bytes;
}

}  // namespace emax
