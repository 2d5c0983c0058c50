#pragma once

#include <cstddef>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// What of any mesh can be edited as a surface: manifold, consistently oriented, free of degenerate
// triangles and of self-intersections. Vertices of equal coordinates are merged first and triangles
// turned to agree. Then triangles are dropped, never added:
// - with a repeated vertex or no area, and all but the first on the same three vertices;
// - at an edge of more than two, all but the two that run through it in opposite directions and
//   continue each other best, or but the largest; at an edge of two that disagree, the smaller;
// - at a vertex of several fans, all but the fan of the greatest area;
// - of triangles that meet beyond what they share, those that meet most others.
// `dropped` counts them. Vertices that are left without triangles go.
// Throws Error for an index out of range or a coordinate that is not finite or beyond 1e150.
// O(n log n) but for the rounds that dropping takes.
struct ManifoldPart {
  TriangleMesh mesh;
  std::size_t dropped = 0;
};
ManifoldPart manifold_part(TriangleMesh mesh);

}  // namespace emax
