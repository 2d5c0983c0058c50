#pragma once

#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// The mesh without the components that no point of the cloud needs. The one of the greatest area
// stays; another does if a point nearest to it is farther than `far` from all that stay and are at
// least eight times as large. So points within `far` of the mesh stay within it, and the others as
// near as they are. Scans that overlap, and noise, leave many small pieces close to the surface.
// `mesh` is as manifold_part() gives it. O(log n) a point and for each of a few rounds.
TriangleMesh drop_needless_components(TriangleMesh mesh, std::span<const Point> cloud, double far);

}  // namespace emax
