#include "host/geometry/mesh_validity.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "host/geometry/box_pairs.h"
#include "host/geometry/disjoint_sets.h"
#include "host/geometry/exact_predicates.h"
#include "host/geometry/triangle_pair.h"

namespace emax {
namespace {

bool repeats_index(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// One side of a triangle, seen from its vertex of lower index.
struct Side {
  std::uint32_t upper;       // the other vertex
  bool ascends;              // the triangle runs from lower to upper
  std::size_t lower_corner;  // 3 * triangle + the place of the vertex in it
  std::size_t upper_corner;
};

// All sides, grouped by edge: `begin_of[v]` is where those of lower vertex v begin, and there they
// are sorted by upper vertex.
struct Sides {
  std::vector<std::size_t> begin_of;
  std::vector<Side> sides;
};

Sides sides_by_edge(const MeshView& mesh) {
  Sides result;
  result.begin_of.assign(mesh.vertices.size() + 1, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& triangle = mesh.triangles[t];
      if (repeats_index(triangle)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const bool ascends = triangle[i] < triangle[j];
        const std::size_t lower = ascends ? i : j;
        const std::size_t upper = ascends ? j : i;
        visit(triangle[lower], Side{triangle[upper], ascends, 3 * t + lower, 3 * t + upper});
      }
    }
  };
  for_each_side([&](std::uint32_t lower, const Side&) { ++result.begin_of[lower + 1]; });
  std::partial_sum(result.begin_of.begin(), result.begin_of.end(), result.begin_of.begin());
  result.sides.resize(result.begin_of.back());
  std::vector<std::size_t> next(result.begin_of.begin(), result.begin_of.end() - 1);
  for_each_side([&](std::uint32_t lower, const Side& side) { result.sides[next[lower]++] = side; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto at = [&](std::size_t i) {
      return result.sides.begin() + static_cast<std::ptrdiff_t>(result.begin_of[i]);
    };
    std::sort(at(v), at(v + 1), [](const Side& a, const Side& b) { return a.upper < b.upper; });
  }
  return result;
}

void check_topology(const MeshView& mesh, MeshValidity& validity) {
  const Sides by_edge = sides_by_edge(mesh);
  const std::vector<Side>& sides = by_edge.sides;
  DisjointSets triangles(mesh.triangles.size());
  DisjointSets fans(3 * mesh.triangles.size());  // of corners at the same vertex
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (std::size_t begin = by_edge.begin_of[v]; begin < by_edge.begin_of[v + 1];) {
      std::size_t end = begin + 1;
      while (end < by_edge.begin_of[v + 1] && sides[end].upper == sides[begin].upper) {
        triangles.join(sides[end].lower_corner / 3, sides[begin].lower_corner / 3);
        fans.join(sides[end].lower_corner, sides[begin].lower_corner);
        fans.join(sides[end].upper_corner, sides[begin].upper_corner);
        ++end;
      }
      const std::size_t users = end - begin;
      if (users == 1) ++validity.boundary_edges;
      if (users == 2 && sides[begin].ascends == sides[begin + 1].ascends) {
        ++validity.inconsistent_edges;
      }
      if (users > 2) ++validity.non_manifold_edges;
      begin = end;
    }
  }
  std::vector<std::uint8_t> fans_at(mesh.vertices.size(), 0);  // 2 for more than one
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (repeats_index(mesh.triangles[t])) continue;
    if (triangles.root(t) == t) ++validity.components;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint8_t& seen = fans_at[mesh.triangles[t][i]];
      if (fans.root(3 * t + i) == 3 * t + i && seen < 2) ++seen;
    }
  }
  validity.non_manifold_vertices =
      static_cast<std::size_t>(std::count(fans_at.begin(), fans_at.end(), 2));
}

}  // namespace

MeshValidity check_mesh(const MeshView& mesh) {
  MeshValidity validity;
  check_topology(mesh, validity);

  std::vector<Bounds> boxes;
  std::vector<std::uint32_t> triangle_of;  // of each box
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Point, 3> corners = mesh.corners(t);
    if (repeats_index(mesh.triangles[t]) || collinear(corners[0], corners[1], corners[2])) {
      ++validity.degenerate_triangles;
      continue;
    }
    boxes.push_back(bounds_of(corners));
    triangle_of.push_back(static_cast<std::uint32_t>(t));
  }
  std::vector<std::uint8_t> intersects(mesh.triangles.size(), 0);
  BoxPairs(boxes).for_each([&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t first = triangle_of[i];
    const std::uint32_t second = triangle_of[j];
    if (!intersect_beyond_shared(mesh, first, second)) return;
    ++validity.self_intersections;
    intersects[first] = intersects[second] = 1;
  });
  validity.self_intersecting_triangles =
      static_cast<std::size_t>(std::count(intersects.begin(), intersects.end(), 1));
  return validity;
}

}  // namespace emax
