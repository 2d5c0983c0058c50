#pragma once

#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Removes the components that no point of the cloud needs. The component of the greatest area
// stays. The others are tested in rounds, the largest first; areas within a factor of eight share a
// round. A component stays if it is the nearest to a point that is farther than `far` from all
// components that stayed in earlier rounds. So points within `far` of the mesh stay within `far`,
// and the distance of the other points does not change. Scans that overlap, and noise, leave many
// small pieces close to the surface. `mesh` is as manifold_part() gives it. O(log n) a point and
// for each of a few rounds.
TriangleMesh drop_needless_components(TriangleMesh mesh, std::span<const Point> cloud, double far);

}  // namespace emax
