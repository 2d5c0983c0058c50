#pragma once

#include <cstddef>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Flips edges until no flip makes the total absolute mean curvature less, the sum of length times
// turn over all edges: of the surfaces through the same vertices a smooth one, which needs fewer
// triangles within a tolerance (Dyn, Hormann, Kim, Levin 2001, "Optimizing 3D triangulations using
// discrete curvature analysis"). The turn is measured as the difference of the unit normals.
// Borders stay, no edge comes twice, no triangle turns over, and none becomes thinner than
// kThinnest that was not, nor intersects another.
//
// `mesh` is as manifold_part() gives it, and stays so. Returns the number of flips that it is apart
// from what it was. O(n log n) where few flips make triangles intersect.
inline constexpr double kThinnest = 0.05;  // height over longest side
std::size_t flip_edges(TriangleMesh& mesh);

// What flip_edges() makes less.
double total_turn(const TriangleMesh& mesh);

}  // namespace emax
