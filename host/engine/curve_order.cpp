#include "host/engine/curve_order.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "sw_model/base/morton.h"
#include "sw_model/base/parallel.h"
#include "sw_model/model/triangle_frame.h"

namespace emax {
namespace {

constexpr std::uint32_t kCells = 1024;
constexpr std::size_t kItems = 4096;  // vertices or triangles that a thread takes at a time

// spread_bits() of every value of ten bits.
constexpr auto kSpread = [] {
  std::array<std::uint32_t, kCells> table{};
  for (std::uint32_t value = 0; value < kCells; ++value) {
    table[value] = static_cast<std::uint32_t>(spread_bits(value));
  }
  return table;
}();

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
                std::size_t first, std::size_t last, std::span<LeafKey> keys) {
  constexpr double kReach = 1.0625, kScale = kCells / (6 * kReach), kShift = kCells * 0.5;
  for (std::size_t i = first; i < last; ++i) {
    const Triangle& t = triangles[i];
    const auto& a = vertices[t[0]].at;
    const auto& b = vertices[t[1]].at;
    const auto& c = vertices[t[2]].at;
    const auto cell = [&](std::size_t axis) {
      const double at = (a[axis] + b[axis] + c[axis]) * kScale + kShift;
      return kSpread[static_cast<std::size_t>(
          static_cast<std::int32_t>(std::max(0.0, std::min(kCells - 1.0, at))))];
    };
    keys[i] = {cell(0) << 2 | cell(1) << 1 | cell(2), static_cast<std::uint32_t>(i)};
  }
}

// Stable, least significant digit first. The result is in `sorted`; both are overwritten.
void radix_sort(std::span<LeafKey> keys, std::span<LeafKey> sorted) {
  constexpr int kDigitBits = 10, kDigits = 3;
  constexpr std::uint32_t kValues = 1u << kDigitBits;
  static_assert(kDigits % 2 == 1, "the last pass ends in `sorted`");
  const auto digit = [](const LeafKey& key, int d) {
    return key.code >> (kDigitBits * d) & (kValues - 1);
  };
  std::array<std::array<std::uint32_t, kValues>, kDigits> starts{};
  for (const LeafKey& key : keys) {
    for (int d = 0; d < kDigits; ++d) ++starts[static_cast<std::size_t>(d)][digit(key, d)];
  }
  for (int d = 0; d < kDigits; ++d) {
    auto& start = starts[static_cast<std::size_t>(d)];
    std::uint32_t sum = 0;
    for (std::uint32_t& value : start) sum += std::exchange(value, sum);
    for (const LeafKey& key : keys) sorted[start[digit(key, d)]++] = key;
    std::swap(keys, sorted);
  }
}

}  // namespace

CurveOrder::CurveOrder(MeshView mesh, const Normalization& normalization, std::size_t threads)
    : vertex_count_(mesh.vertices.size()),
      triangle_count_(mesh.triangles.size()),
      vertices_(std::make_unique_for_overwrite<NormalizedVertex[]>(vertex_count_)),
      keys_(std::make_unique_for_overwrite<LeafKey[]>(triangle_count_)),
      corners_(std::make_unique_for_overwrite<Triangle[]>(triangle_count_)) {
  const std::span<NormalizedVertex> vertices(vertices_.get(), vertex_count_);
  std::atomic<bool> in_range = true;
  in_pieces(threads, vertex_count_, kItems, [&](std::size_t, std::size_t first, std::size_t last) {
    if (!normalize(mesh.vertices, normalization, first, last, vertices)) in_range = false;
  });
  if (!in_range) make_records(mesh, normalization);  // names a triangle with such a vertex

  const auto memory = std::make_unique_for_overwrite<LeafKey[]>(triangle_count_);
  const std::span<LeafKey> unsorted(memory.get(), triangle_count_);
  in_pieces(threads, triangle_count_, kItems,
            [&](std::size_t, std::size_t first, std::size_t last) {
              make_codes(vertices, mesh.triangles, first, last, unsorted);
            });
  radix_sort(unsorted, {keys_.get(), triangle_count_});
  in_pieces(threads, triangle_count_, kItems,
            [&](std::size_t, std::size_t first, std::size_t last) {
              for (std::size_t i = first; i < last; ++i) {
                corners_[i] = mesh.triangles[keys_[i].triangle];
              }
            });
}

}  // namespace emax
