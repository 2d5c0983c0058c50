#pragma once

#include <cstddef>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// The part of any mesh that can be edited as a surface: manifold, consistently oriented, free of
// degenerate triangles and of self-intersections. First, vertices of equal coordinates are merged
// and triangles are turned to agree with their neighbours. Then these triangles are dropped:
// - triangles with a repeated vertex or no area, and all but the first on the same three vertices;
// - at an edge of more than two triangles, all but the two that run through it in opposite
//   directions and continue each other best, or all but the largest; at an edge of two triangles
//   that disagree, the smaller;
// - at a vertex of several fans, all but the fan of the greatest area;
// - of triangles that meet beyond the vertices and edges that they share, those that meet most
//   others.
// `dropped` counts them. Vertices without triangles are removed. No triangle is added.
// Throws Error for an index out of range or a coordinate that is not finite or beyond 1e150.
// O(n log n), apart from the rounds that dropping takes.
struct ManifoldPart {
  TriangleMesh mesh;
  std::size_t dropped = 0;
};
ManifoldPart manifold_part(TriangleMesh mesh);

// Any mesh as a surface that can be edited, with all of its triangles that have an area: manifold
// and consistently oriented. Where the mesh is not manifold, it is cut apart (after Guéziec et al.,
// "Converting sets of polygons to manifold surfaces by cutting and stitching", 1998). First,
// vertices of equal coordinates are merged and triangles are turned to agree with their neighbours.
// Then
// - triangles with a repeated vertex or no area are dropped, and all but the first on the same
//   three vertices; where a triangle without area lies along a side of another triangle, that side
//   is split instead;
// - at an edge of more than two triangles, those that continue each other best stay joined in
//   pairs, and the others get a border there; two triangles that run through an edge in the same
//   direction also get a border there;
// - a vertex is split into one vertex for each of its fans of joined triangles.
// Triangles that meet each other stay. Throws as manifold_part() does. O(n log n).
struct CutSurface {
  TriangleMesh mesh;
  std::size_t merged = 0;        // vertices merged into others of the same coordinates
  std::size_t turned = 0;        // triangles that disagreed with their neighbours
  std::size_t dropped = 0;       // triangles without area, repeated, or that no cut made manifold
  std::size_t split = 0;         // triangles, at vertices on their sides
  std::size_t cut_edges = 0;     // edges at which triangles were separated
  std::size_t cut_vertices = 0;  // vertices that became more than one
};
CutSurface cut_to_manifold(TriangleMesh mesh);

}  // namespace emax
