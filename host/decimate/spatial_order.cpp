#include "host/decimate/spatial_order.h"

#include <algorithm>
#include <utility>

#include "host/geometry/bounds.h"
#include "sw_model/base/morton.h"

namespace emax {
namespace {

constexpr double kCells = 1 << 21;  // along an axis

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const Point> points) {
  if (points.empty()) return {};
  const Bounds box = bounds_of(points);
  const double width = box.width() > 0 ? box.width() : 1;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(points.size());
  for (const Point& p : points) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = (p[axis] - box.lower[axis]) / width * (kCells - 1);
      key |= spread_bits(static_cast<std::uint64_t>(at)) << axis;
    }
    keys.emplace_back(key, static_cast<std::uint32_t>(keys.size()));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& [key, index] : keys) order.push_back(index);
  return order;
}

TriangleMesh spatially_ordered(const TriangleMesh& mesh) {
  TriangleMesh result;
  std::vector<std::uint32_t> number(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) number[v] = 1;
  }
  result.vertices.reserve(mesh.vertices.size());
  for (const std::uint32_t v : spatial_order(mesh.vertices)) {
    if (number[v] == 0) continue;
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
  }
  result.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Triangle turned = {number[t[0]], number[t[1]], number[t[2]]};
    std::rotate(turned.begin(), std::min_element(turned.begin(), turned.end()), turned.end());
    result.triangles.push_back(turned);
  }
  std::sort(result.triangles.begin(), result.triangles.end());
  return result;
}

}  // namespace emax
