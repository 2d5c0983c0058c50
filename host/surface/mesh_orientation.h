#pragma once

#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Turns triangles so that the two at every edge of exactly two triangles run through it in opposite
// directions, wherever the surface can be oriented. A part that is connected through such edges
// faces the side that the greater share of its area votes for: with `normals` (one per vertex) the
// side they point to, without them the side it had. Returns the number of turned triangles. O(t log
// t).
std::size_t orient_consistently(TriangleMesh& mesh, std::span<const Eigen::Vector3f> normals = {});

// Drops triangles on the same three vertices in pairs: a fold that encloses nothing and makes its
// edges non-manifold. O(t log t).
void drop_folds(TriangleMesh& mesh);

// Drops triangles that repeat a vertex, then vertices that no triangle uses; the order stays.
void drop_unused(TriangleMesh& mesh);

}  // namespace emax
