#include "host/geometry/merge_vertices.h"

#include <bit>
#include <unordered_map>

namespace emax {
namespace {

struct PointHash {
  std::size_t operator()(const Point& p) const {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(p[k])) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

}  // namespace

void merge_equal_vertices(std::vector<Point>& vertices, std::vector<Triangle>& triangles) {
  std::unordered_map<Point, std::uint32_t, PointHash> index_of;
  index_of.reserve(triangles.size());
  std::vector<Point> merged;
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) {
      const Point point = vertices[corner] + Point::Zero();  // turns -0 into 0
      const auto [entry, is_new] =
          index_of.try_emplace(point, static_cast<std::uint32_t>(merged.size()));
      if (is_new) merged.push_back(point);
      corner = entry->second;
    }
  }
  vertices = std::move(merged);
}

std::vector<bool> used_vertices(std::size_t vertex_count, std::span<const Triangle> triangles) {
  std::vector<bool> used(vertex_count, false);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  return used;
}

void drop_unused_vertices(std::vector<Point>& vertices, std::vector<Triangle>& triangles) {
  const std::vector<bool> used = used_vertices(vertices.size(), triangles);
  std::vector<std::uint32_t> kept(vertices.size(), 0);
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (!used[v]) continue;
    kept[v] = count;
    vertices[count++] = vertices[v];
  }
  vertices.resize(count);
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = kept[v];
  }
}

}  // namespace emax
