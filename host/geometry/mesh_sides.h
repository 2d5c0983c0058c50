#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// On which side of a mesh a point lies. Where the nearest point of the mesh is inside a triangle,
// the triangle's normal decides; on an edge the sum of the unit normals of the edge's triangles, at
// a vertex their sum weighted by the angles there (Baerentzen and Aanaes, "Signed distance
// computation using the angle weighted pseudonormal", 2005). That is right for every mesh whose
// triangles are consistently oriented; a triangle's own normal alone is wrong beside sharp edges
// and vertices.
//
// Triangles run counter-clockwise seen from the positive side. Where a mesh without borders has a
// negative volume, its triangles are turned, so that positive is outside. Degenerate triangles
// count for nothing.
class MeshSides {
 public:
  // Indices are in range. O(n log n) as EdgeSides.
  explicit MeshSides(MeshView mesh);

  // 1, or -1 on the negative side. `nearest`: a triangle that is nearest to p. O(1).
  double side_of(const Point& p, std::uint32_t nearest) const;

 private:
  MeshView mesh_;
  std::vector<std::array<Point, 3>> at_edges_;  // of each triangle: from corner i to corner i + 1
  std::vector<Point> at_vertices_;
  bool inside_out_ = false;
};

}  // namespace emax
