#include "host/surface/mesh_orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "host/geometry/merge_vertices.h"

namespace emax {
namespace {

struct HalfEdge {
  std::uint32_t low, high;  // the edge's vertices
  std::uint32_t triangle;
  bool rising;  // the triangle runs through the edge from low to high

  auto edge() const { return std::pair(low, high); }
};

struct Neighbour {
  std::uint32_t triangle;
  bool opposed;  // the two triangles run through the edge in opposite directions
};

// Up to three neighbours a triangle, through edges of exactly two triangles.
std::vector<std::vector<Neighbour>> manifold_neighbours(std::span<const Triangle> triangles) {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(triangles.size() * 3);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = triangles[t][corner];
      const std::uint32_t to = triangles[t][(corner + 1) % 3];
      half_edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return std::pair(x.edge(), x.triangle) < std::pair(y.edge(), y.triangle);
  });
  std::vector<std::vector<Neighbour>> neighbours(triangles.size());
  for (std::size_t first = 0, last = 0; first < half_edges.size(); first = last) {
    while (last < half_edges.size() && half_edges[last].edge() == half_edges[first].edge()) ++last;
    if (last - first != 2) continue;
    const HalfEdge& x = half_edges[first];
    const HalfEdge& y = half_edges[first + 1];
    neighbours[x.triangle].push_back({y.triangle, x.rising != y.rising});
    neighbours[y.triangle].push_back({x.triangle, x.rising != y.rising});
  }
  return neighbours;
}

// The triangle's area, negative when it faces against its vertices' normals.
double vote(const TriangleMesh& mesh, std::span<const Eigen::Vector3f> normals, std::uint32_t t) {
  const auto [a, b, c] = mesh.view().corners(t);
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (normals.empty()) return normal.norm();
  const Triangle& triangle = mesh.triangles[t];
  const Eigen::Vector3f side = normals[triangle[0]] + normals[triangle[1]] + normals[triangle[2]];
  return normal.dot(side.cast<double>());
}

}  // namespace

std::size_t orient_consistently(TriangleMesh& mesh, std::span<const Eigen::Vector3f> normals) {
  const auto neighbours = manifold_neighbours(mesh.triangles);
  std::vector<bool> seen(mesh.triangles.size(), false);
  std::vector<bool> turned(mesh.triangles.size(), false);
  std::vector<std::uint32_t> part;
  std::size_t swapped = 0;
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (seen[seed]) continue;
    part.assign(1, seed);
    seen[seed] = true;
    double votes = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t t = part[i];
      votes += turned[t] ? -vote(mesh, normals, t) : vote(mesh, normals, t);
      for (const auto& [next, opposed] : neighbours[t]) {
        if (seen[next]) continue;
        seen[next] = true;
        turned[next] = turned[t] == opposed;
        part.push_back(next);
      }
    }
    for (const std::uint32_t t : part) {
      if (turned[t] == (votes < 0)) continue;
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      ++swapped;
    }
  }
  return swapped;
}

void drop_folds(TriangleMesh& mesh) {
  std::vector<std::pair<Triangle, std::uint32_t>> sorted;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    sorted.emplace_back(mesh.triangles[t], t);
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> dropped(mesh.triangles.size(), false);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[i - 1].first || dropped[sorted[i - 1].second]) continue;
    dropped[sorted[i].second] = dropped[sorted[i - 1].second] = true;
  }
  std::uint32_t t = 0;
  std::erase_if(mesh.triangles, [&](const Triangle&) { return dropped[t++]; });
}

void drop_unused(TriangleMesh& mesh) {
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  drop_unused_vertices(mesh.vertices, mesh.triangles);
}

}  // namespace emax
