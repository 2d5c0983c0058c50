#include "host/surface/outward.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "host/geometry/disjoint_sets.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/exact_predicates.h"

namespace emax {
namespace {

constexpr std::uint32_t kNoPart = ~0u;

// The closed components of a mesh.
struct ClosedParts {
  std::vector<std::uint32_t> of_triangle;  // the component, or kNoPart if it has a border
  std::vector<std::uint32_t> vertex;       // one of each component
  std::vector<double> volume;  // of each component, times 6; negative where it faces inward
};

ClosedParts closed_parts(const TriangleMesh& mesh) {
  const std::size_t triangles = mesh.triangles.size();
  DisjointSets joined(triangles);
  std::vector<std::uint8_t> open(triangles, 0);
  EdgeSides(mesh.view()).for_each_edge([&](std::span<const EdgeSide> sides) {
    if (sides.size() == 2 && sides[0].ascends != sides[1].ascends) {
      joined.join(sides[0].lower_corner / 3, sides[1].lower_corner / 3);
    } else {
      for (const EdgeSide& side : sides) open[side.lower_corner / 3] = 1;
    }
  });
  for (std::size_t t = 0; t < triangles; ++t) {
    if (open[t] != 0 || repeats_index(mesh.triangles[t])) open[joined.root(t)] = 1;
  }
  ClosedParts parts;
  parts.of_triangle.assign(triangles, kNoPart);
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::size_t root = joined.root(t);
    if (open[root] != 0) continue;
    if (root == t) {
      parts.of_triangle[t] = static_cast<std::uint32_t>(parts.vertex.size());
      parts.vertex.push_back(mesh.triangles[t][0]);
      parts.volume.push_back(0);
    }
    const std::uint32_t part = parts.of_triangle[t] = parts.of_triangle[root];
    // Taken from a point of the component, so that its position does not affect the rounding.
    const Point& origin = mesh.vertices[parts.vertex[part]];
    const auto [a, b, c] = mesh.view().corners(t);
    parts.volume[part] += (a - origin).cross(b - origin).dot(c - origin);
  }
  return parts;
}

// Whether the ray from p along x passes through the triangle. A point on an edge, seen along x,
// counts as beyond the edge for every triangle there. From outside, a closed surface is therefore
// passed through an even number of times.
bool is_passed(const Point& p, const TriangleMesh& mesh, const Triangle& triangle) {
  constexpr int kAxis = 0;
  const Eigen::Vector2d at = project(p, kAxis);
  bool over = false;
  for (std::size_t i = 0; i < 3; ++i) {
    Eigen::Vector2d a = project(mesh.vertices[triangle[i]], kAxis);
    Eigen::Vector2d b = project(mesh.vertices[triangle[(i + 1) % 3]], kAxis);
    if ((a.y() <= at.y()) == (b.y() <= at.y())) continue;
    if (a.y() > b.y()) std::swap(a, b);
    over = over != (orient2d(a, b, at) > 0);
  }
  if (!over) return false;
  const auto& [a, b, c] = triangle;
  const Point &first = mesh.vertices[a], &second = mesh.vertices[b], &third = mesh.vertices[c];
  const int turn = orient2d(project(first, kAxis), project(second, kAxis), project(third, kAxis));
  // p lies before the plane, seen along x.
  return orient3d(first, second, third, p) * turn < 0;
}

// For each component, how many others it lies in.
std::vector<std::size_t> depths(const TriangleMesh& mesh, const ClosedParts& parts) {
  const std::size_t count = parts.vertex.size();
  std::vector<std::size_t> depth(count, 0);
  if (count < 2) return depth;
  std::vector<std::uint32_t> by_y(count);  // components ordered by y of their vertex
  for (std::uint32_t i = 0; i < count; ++i) by_y[i] = i;
  const auto place = [&](std::uint32_t part) -> const Point& {
    return mesh.vertices[parts.vertex[part]];
  };
  const auto y = [&](std::uint32_t part) { return place(part).y(); };
  std::ranges::sort(by_y, {}, y);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> passes;  // inner and outer component
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t outer = parts.of_triangle[t];
    if (outer == kNoPart) continue;
    const auto [a, b, c] = mesh.view().corners(t);
    const Point low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    for (auto i = std::ranges::lower_bound(by_y, low.y(), {}, y);
         i != by_y.end() && y(*i) <= high.y(); ++i) {
      const Point& p = place(*i);
      if (*i == outer || p.z() < low.z() || p.z() > high.z() || p.x() > high.x()) continue;
      if (is_passed(p, mesh, mesh.triangles[t])) passes.emplace_back(*i, outer);
    }
  }
  std::ranges::sort(passes);
  for (auto first = passes.begin(); first != passes.end();) {
    const auto last = std::find_if(first, passes.end(), [&](const auto& p) { return p != *first; });
    depth[first->first] += static_cast<std::size_t>(last - first) % 2;
    first = last;
  }
  return depth;
}

}  // namespace

void orient_outward(TriangleMesh& mesh) {
  const ClosedParts parts = closed_parts(mesh);
  const std::vector<std::size_t> depth = depths(mesh, parts);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t part = parts.of_triangle[t];
    if (part == kNoPart) continue;
    const double volume = parts.volume[part];
    const bool inward = depth[part] % 2 == 1;
    if (inward ? volume > 0 : volume < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
}

}  // namespace emax
