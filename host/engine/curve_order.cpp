#include "host/engine/curve_order.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "sw_model/base/morton.h"
#include "sw_model/base/parallel.h"
#include "sw_model/model/triangle_frame.h"

namespace emax {
namespace {

constexpr std::size_t kItems = 4096;  // vertices or triangles that a thread takes at a time

// Returns whether the vertices from `first` to `last` are all in range.
bool normalize(std::span<const Point> vertices, const Normalization& normalization,
               std::size_t first, std::size_t last, std::span<NormalizedVertex> normalized) {
  bool in_range = true;
  for (std::size_t i = first; i < last; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double x = (vertices[i][axis] - normalization.origin[axis]) * normalization.scale;
      in_range &= std::abs(x) <= kMaxNormalizedCoordinate;
      normalized[i].at[static_cast<std::size_t>(axis)] = x;
    }
    normalized[i].at[3] = 0;
  }
  return in_range;
}

// The cells divide a cube a little larger than the cloud's. Triangles outside get the cells at its
// faces.
void make_codes(std::span<const NormalizedVertex> vertices, std::span<const Triangle> triangles,
                std::size_t first, std::size_t last, std::span<MortonKey> keys) {
  constexpr double kReach = 1.0625, kScale = kMortonCells / (6 * kReach),
                   kShift = kMortonCells * 0.5;
  for (std::size_t i = first; i < last; ++i) {
    const Triangle& t = triangles[i];
    const auto& a = vertices[t[0]].at;
    const auto& b = vertices[t[1]].at;
    const auto& c = vertices[t[2]].at;
    const auto cell = [&](std::size_t axis) {
      const double at = (a[axis] + b[axis] + c[axis]) * kScale + kShift;
      return static_cast<std::uint32_t>(
          static_cast<std::int32_t>(std::max(0.0, std::min(kMortonCells - 1.0, at))));
    };
    keys[i] = {morton_code(cell(0), cell(1), cell(2)), static_cast<std::uint32_t>(i)};
  }
}

}  // namespace

CurveOrder::CurveOrder(MeshView mesh, const Normalization& normalization, std::size_t threads)
    : vertex_count_(mesh.vertices.size()),
      triangle_count_(mesh.triangles.size()),
      vertices_(std::make_unique_for_overwrite<NormalizedVertex[]>(vertex_count_)),
      keys_(std::make_unique_for_overwrite<MortonKey[]>(triangle_count_)),
      corners_(std::make_unique_for_overwrite<Triangle[]>(triangle_count_)) {
  const std::span<NormalizedVertex> vertices(vertices_.get(), vertex_count_);
  std::atomic<bool> in_range = true;
  in_pieces(threads, vertex_count_, kItems, [&](std::size_t, std::size_t first, std::size_t last) {
    if (!normalize(mesh.vertices, normalization, first, last, vertices)) in_range = false;
  });
  if (!in_range) make_records(mesh, normalization);  // names a triangle with such a vertex

  const auto memory = std::make_unique_for_overwrite<MortonKey[]>(triangle_count_);
  const std::span<MortonKey> unsorted(memory.get(), triangle_count_);
  in_pieces(threads, triangle_count_, kItems,
            [&](std::size_t, std::size_t first, std::size_t last) {
              make_codes(vertices, mesh.triangles, first, last, unsorted);
            });
  sort_by_code(unsorted, {keys_.get(), triangle_count_});
  in_pieces(threads, triangle_count_, kItems,
            [&](std::size_t, std::size_t first, std::size_t last) {
              for (std::size_t i = first; i < last; ++i) {
                corners_[i] = mesh.triangles[keys_[i].item];
              }
            });
}

}  // namespace emax
