#include "host/geometry/mesh_topology.h"

#include <fmt/format.h>

#include <vector>

#include "host/geometry/disjoint_sets.h"
#include "host/geometry/edge_sides.h"

namespace emax {

MeshTopology topology_of(const MeshView& mesh) {
  const std::size_t corners = 3 * mesh.triangles.size();
  DisjointSets triangles(mesh.triangles.size());
  DisjointSets fans(corners);  // the vertices of the cut surface
  std::vector<EdgeSide> borders;
  std::size_t edges = 0;
  EdgeSides(mesh).for_each_edge([&](std::span<const EdgeSide> sides) {
    if (sides.size() == 2 && sides[0].ascends != sides[1].ascends) {
      triangles.join(sides[0].lower_corner / 3, sides[1].lower_corner / 3);
      fans.join(sides[0].lower_corner, sides[1].lower_corner);
      fans.join(sides[0].upper_corner, sides[1].upper_corner);
      ++edges;
    } else {
      borders.insert(borders.end(), sides.begin(), sides.end());
      edges += sides.size();
    }
  });
  MeshTopology topology;
  std::size_t vertices = 0, faces = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (repeats_index(mesh.triangles[t])) continue;
    ++faces;
    if (triangles.root(t) == t) ++topology.components;
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      if (fans.root(c) == c) ++vertices;
    }
  }
  // Each vertex on a border of the cut surface has two border sides, so the sides form loops. The
  // side that joins nothing new closes a loop.
  for (const EdgeSide& side : borders) {
    if (!fans.join(side.lower_corner, side.upper_corner)) ++topology.border_loops;
  }
  // 2 components - border loops - characteristic. In this order no unsigned difference is negative.
  topology.genus = (2 * topology.components + edges - topology.border_loops - vertices - faces) / 2;
  return topology;
}

std::string describe(const MeshTopology& topology) {
  const auto counted = [](std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  return fmt::format(
      "{}, {}, genus {}", counted(topology.components, "component"),
      topology.border_loops == 0 ? "closed" : counted(topology.border_loops, "border"),
      topology.genus);
}

}  // namespace emax
