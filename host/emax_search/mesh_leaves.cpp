#include "host/emax_search/mesh_leaves.h"

#include <algorithm>
#include <utility>

#include "host/emax_search/curve_order.h"
#include "host/emax_search/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kPiece = 4096;  // triangles
static_assert(kPiece % kTreeWidth == 0);

}  // namespace

MeshLeaves::MeshLeaves(MeshView mesh, const Normalization& normalization,
                       const EngineTarget& target, std::size_t threads, std::span<BoxBlock> blocks)
    : count_(mesh.triangles.size()) {
  CurveOrder order(mesh, normalization, threads);
  records_ = std::make_unique_for_overwrite<TriangleRecord<float>[]>(count_);
  const std::span<TriangleRecord<float>> records(records_.get(), count_);
  std::vector<float> reach((count_ + kPiece - 1) / kPiece);
  in_pieces(threads, count_, kPiece, [&](std::size_t, std::size_t first, std::size_t last) {
    const std::size_t count = last - first;
    reach[first / kPiece] = target.make_leaves(
        order.vertices(), order.corners().subspan(first, count), order.keys().subspan(first, count),
        records.subspan(first, count),
        blocks.subspan(first / kTreeWidth, (count + kTreeWidth - 1) / kTreeWidth));
  });
  reach_ = *std::ranges::max_element(reach);
  keys_ = order.take_keys();
}

std::vector<std::uint32_t> MeshLeaves::places_in(const MeshLeaves& now) const {
  std::vector<std::uint32_t> places(count_);
  std::size_t place = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    while (place < now.count_ && now.keys_[place].code < keys_[i].code) ++place;
    places[i] = static_cast<std::uint32_t>(place);
  }
  return places;
}

}  // namespace emax
