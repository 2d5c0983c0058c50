#pragma once

#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// The mesh without the components that no point of the cloud needs. One is needed if it is the one
// of the greatest area, or if a point nearest to it is farther than `far` from that one. So points
// within `far` of the mesh stay within it, and the others as near as they are. Scans that overlap,
// and hulls of noise, leave many small pieces close to the surface. `mesh` is as manifold_part()
// gives it. O(log n) a point.
TriangleMesh drop_needless_components(TriangleMesh mesh, std::span<const Point> cloud, double far);

}  // namespace emax
