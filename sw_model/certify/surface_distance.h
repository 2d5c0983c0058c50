#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"
#include "sw_model/certify/exact_distance.h"

namespace emax {

// The greatest distance from any point of a mesh, the inside of its triangles included, to a
// reference, as an interval of which both ends are proven. In the coordinates and the unit of the
// input, rounded outward, and independent of the kernel (docs/numerics.md).
struct SurfaceDistance {
  double lower = 0, upper = 0;
  Point witness = Point::Zero();  // a point of the mesh at least `lower` from the reference
  std::uint32_t triangle = 0;     // of the mesh; the witness lies on it up to rounding
  std::size_t cuts = 0;

  bool within(double epsilon) const { return upper <= epsilon; }
};

struct SurfaceDistanceOptions {
  // The search ends when `upper` is at most lower * (1 + relative) or lower + absolute, or when
  // only 2^-30 of the mesh's extent or roundings are left between the two.
  double relative = 0.01;
  double absolute = 0;
  // At least 0: the search is a decision. It also ends when `upper` is at most this limit (every
  // point of the mesh is within it), or `lower` is above it (the witness is not). Negative: no
  // decision.
  double limit = -1;
  // Called now and then; an exception ends the search and comes out.
  std::function<void()> poll = nullptr;
};

// Branch and bound over the mesh's triangles, the one with the greatest bound first, and over the
// pieces that each is cut into, convex polygons. The distance to one triangle of the reference is a
// convex function, so over a piece it is greatest at a corner: the least of these maxima over a few
// triangles of the reference bounds the piece, and the distances of corners bound the result from
// below. A piece is cut where the triangle that bounds it and the one near its worst corner are
// equally far, so that the pieces come to follow the reference's own faces. A triangle of the
// reference that is near one vertex is tried for its neighbours, which settles most triangles of a
// fine mesh without a query.
//
// Throws Error for a mesh without triangles or with a vertex that is not finite or beyond 1e150;
// std::invalid_argument for an index out of range; std::logic_error while flush mode is on.
// At most a nearest-triangle query of O(log reference) per vertex, triangle and cut; a quarter of
// the vertices of a fine mesh need one. Cuts are about as many as pairs of triangles that face each
// other where the distance comes near its maximum; where the mesh lies in the reference they grow
// with log(1 / absolute). 48 bytes per vertex, 16 per triangle to be cut. The pieces of one
// triangle at a time are in hand.
SurfaceDistance surface_distance(MeshView mesh, const ExactMesh& reference,
                                 const SurfaceDistanceOptions& options = {});

// Decides whether the distance is within the limit. Where it is, `upper` may lie anywhere up to the
// limit.
SurfaceDistance decided_distance(MeshView mesh, const ExactMesh& reference, double limit);

// A cloud as a reference: every point is a triangle of no size.
std::vector<Triangle> triangles_of_points(std::size_t points);

}  // namespace emax
