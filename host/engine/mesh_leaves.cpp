#include "host/engine/mesh_leaves.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "host/engine/curve_order.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kTriangles = 4096;  // triangles
static_assert(kTriangles % kTreeWidth == 0);
constexpr std::size_t kMostInCell = 8;  // at most this many leaves of a cell are compared

bool same_triangle(const TriangleRecord<float>& a, const TriangleRecord<float>& b) {
  return std::memcmp(&a, &b, offsetof(TriangleRecord<float>, tag)) == 0 &&
         ((a.tag ^ b.tag) & kSegmentFlag) == 0;
}

}  // namespace

MeshLeaves::MeshLeaves(MeshView mesh, const Normalization& normalization,
                       const EngineTarget& target, std::size_t threads, std::span<BoxBlock> blocks)
    : count_(mesh.triangles.size()) {
  CurveOrder order(mesh, normalization, threads);
  records_ = std::make_unique_for_overwrite<TriangleRecord<float>[]>(count_);
  const std::span<TriangleRecord<float>> records(records_.get(), count_);
  std::vector<float> reach((count_ + kTriangles - 1) / kTriangles);
  in_pieces(threads, count_, kTriangles, [&](std::size_t, std::size_t first, std::size_t last) {
    const std::size_t count = last - first;
    reach[first / kTriangles] = target.make_leaves(
        order.vertices(), order.corners().subspan(first, count), order.keys().subspan(first, count),
        records.subspan(first, count),
        blocks.subspan(first / kTreeWidth, (count + kTreeWidth - 1) / kTreeWidth));
  });
  reach_ = *std::ranges::max_element(reach);
  keys_ = order.take_keys();
}

std::vector<std::uint32_t> MeshLeaves::carried_to(const MeshLeaves& now) const {
  std::vector<std::uint32_t> carried(count_ + 1, kNoLeaf);
  std::size_t cell = 0;  // the first leaf of `now` whose cell is not before leaf i's
  for (std::size_t i = 0; i < count_; ++i) {
    const std::uint32_t code = keys_[i].code;
    while (cell < now.count_ && now.keys_[cell].code < code) ++cell;
    const std::size_t end = std::min(cell + kMostInCell, now.count_);
    for (std::size_t j = cell; j < end && now.keys_[j].code == code; ++j) {
      if (same_triangle(records_[i], now.records_[j])) {
        carried[i] = static_cast<std::uint32_t>(j);
        break;
      }
    }
  }
  return carried;
}

}  // namespace emax
