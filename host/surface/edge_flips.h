#pragma once

#include <cstddef>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Flips edges as long as a flip reduces the total absolute mean curvature: the sum over all edges
// of length times turn, where the turn is the difference of the unit normals. Of the surfaces
// through the same vertices this gives a smooth one, which needs fewer triangles within a tolerance
// (Dyn, Hormann, Kim, Levin 2001, "Optimizing 3D triangulations using discrete curvature
// analysis"). Borders stay, no edge occurs twice, no triangle turns over, and none intersects
// another because of a flip. Two triangles become thinner than kThinnest only where one of them was
// at least as thin before. `mesh` is as manifold_part() gives it, and stays so. Returns the number
// of flips between the given mesh and the result. O(n log n) where few flips make triangles
// intersect.
inline constexpr double kThinnest = 0.05;  // height over longest side
std::size_t flip_edges(TriangleMesh& mesh);

// The sum that flip_edges() reduces.
double total_turn(const TriangleMesh& mesh);

}  // namespace emax
