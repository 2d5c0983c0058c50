#include "host/emax_search/prepared_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sw_model/error.h"
#include "sw_model/flush_mode.h"
#include "sw_model/triangle_frame.h"

namespace emax {
namespace {

// Every third bit of ten.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ffu;
  bits = (bits | bits << 8) & 0x0300f00fu;
  bits = (bits | bits << 4) & 0x030c30c3u;
  return (bits | bits << 2) & 0x09249249u;
}

// Cells of a cube a little larger than the cloud's; what lies outside falls into the cells at its
// faces. NaN goes to cell 0: the leaves report it.
std::uint32_t cell(double normalized) {
  constexpr double kReach = 1.0625, kCells = 1024;
  const double at = (normalized + kReach) * (kCells / (2 * kReach));
  return at > 0 ? static_cast<std::uint32_t>(std::min(at, kCells - 1)) : 0;
}

struct Keyed {
  std::uint32_t code, triangle;
};

std::vector<Keyed> with_codes(MeshView mesh, const Normalization& normalization) {
  std::vector<Keyed> keyed(mesh.triangles.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Point& a = mesh.vertices[t[0]];
    const Point& b = mesh.vertices[t[1]];
    const Point& c = mesh.vertices[t[2]];
    std::uint32_t code = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double middle = (a[axis] + b[axis] + c[axis]) * (1.0 / 3);
      code |= spread(cell((middle - normalization.origin[axis]) * normalization.scale))
              << (2 - axis);
    }
    keyed[i] = {code, static_cast<std::uint32_t>(i)};
  }
  return keyed;
}

// Stable, least significant digit first.
void radix_sort(std::vector<Keyed>& keyed) {
  constexpr int kDigitBits = 10, kDigits = 3;
  constexpr std::uint32_t kValues = 1u << kDigitBits;
  std::array<std::array<std::uint32_t, kValues>, kDigits> starts{};
  for (const Keyed& k : keyed) {
    for (std::size_t d = 0; d < kDigits; ++d) {
      ++starts[d][k.code >> (kDigitBits * static_cast<int>(d)) & (kValues - 1)];
    }
  }
  std::vector<Keyed> sorted(keyed.size());
  for (std::size_t d = 0; d < kDigits; ++d) {
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts[d]) sum += std::exchange(start, sum);
    for (const Keyed& k : keyed) {
      sorted[starts[d][k.code >> (kDigitBits * static_cast<int>(d)) & (kValues - 1)]++] = k;
    }
    keyed.swap(sorted);
  }
}

std::size_t blocks_for(std::size_t children) { return (children + kTreeWidth - 1) / kTreeWidth; }

}  // namespace

PreparedMesh::PreparedMesh(MeshView mesh, const Normalization& normalization,
                           const EngineTarget& target) {
  if (mesh.triangles.empty()) throw Error("the mesh has no triangles to measure a distance to");
  require_no_flush("making triangle frames");
  std::vector<Keyed> keyed = with_codes(mesh, normalization);
  radix_sort(keyed);
  std::vector<std::uint32_t> order(keyed.size());
  std::transform(keyed.begin(), keyed.end(), order.begin(),
                 [](const Keyed& k) { return k.triangle; });

  std::vector<std::size_t> sizes = {blocks_for(order.size())};
  while (sizes.back() > 1) sizes.push_back(blocks_for(sizes.back()));
  std::size_t all = 0;
  for (const std::size_t size : sizes) all += size;
  records_.resize(order.size());
  blocks_.resize(all);
  std::span<BoxBlock> rest = blocks_, below;
  for (const std::size_t size : sizes) {
    const std::span<BoxBlock> level = rest.first(size);
    rest = rest.subspan(size);
    if (levels_.empty()) {
      reach_ = target.make_leaves(mesh, normalization, order, records_, level);
      if (std::isinf(reach_)) {
        make_records(mesh, normalization);  // names the triangle
        throw Error("the mesh has a vertex that is not finite or too far away");
      }
    } else {
      target.make_level(below, level);
    }
    levels_.push_back(level);
    below = level;
  }
}

std::size_t PreparedMesh::memory_bytes() const {
  return std::span(records_).size_bytes() + std::span(blocks_).size_bytes();
}

}  // namespace emax
