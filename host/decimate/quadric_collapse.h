#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

struct CollapsedMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertices;  // the number of each vertex in the given mesh; ascending
};

// Fewer triangles for a surface that is sampled evenly, as marching cubes give it, in some 10 us a
// triangle and without the proofs of a BoundedDecimator: edges are collapsed in the order of their
// quadric error (Garland and Heckbert 1997), the least first, as long as the root of the mean
// squared distance of the new vertex from the planes of the triangles that it stands for is at most
// `deviation` and no edge is longer than kLongestEdge times the mean one was. So a bump that is
// higher than a few deviations stays if it is about as wide as two edges.
//
// `mesh` is a manifold, which the result is, too, with the same topology. Vertices whose entry in
// `fixed` is not 0 stay where they are, with the edges between two of them on a border; empty: none
// does. Triangles turn by less than 45 degrees at a time and are no slivers. Where triangles of the
// result meet, what they stand for stays as it was and all is done again. O(n log n); 300 bytes a
// triangle.
inline constexpr double kLongestEdge = 12;
CollapsedMesh collapse_by_quadrics(const TriangleMesh& mesh, double deviation,
                                   std::span<const char> fixed = {});

}  // namespace emax
