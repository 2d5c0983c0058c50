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

// Any mesh as a surface that can be edited, with all of its triangles that have an area: manifold
// and consistently oriented, cut apart where it was not (after Guéziec et al., "Converting sets of
// polygons to manifold surfaces by cutting and stitching", 1998). Vertices of equal coordinates are
// merged first and triangles turned to agree. Then
// - triangles with a repeated vertex or no area go, and all but the first on the same three
//   vertices; where one without area lies along a side of another, that side is split instead;
// - at an edge of more than two triangles those that continue each other best stay joined in pairs,
//   and the others end there; so do two that run through it in the same direction;
// - a vertex becomes as many as it has fans of joined triangles.
// Triangles that meet each other stay. Throws as manifold_part() does. O(n log n).
struct CutSurface {
  TriangleMesh mesh;
  std::size_t merged = 0;        // vertices with others of the same coordinates
  std::size_t turned = 0;        // triangles that disagreed with their neighbours
  std::size_t dropped = 0;       // triangles without area, repeated, or that no cut made manifold
  std::size_t split = 0;         // triangles, at vertices on their sides
  std::size_t cut_edges = 0;     // at which triangles were parted
  std::size_t cut_vertices = 0;  // that became more than one
};
CutSurface cut_to_manifold(TriangleMesh mesh);

}  // namespace emax
