#pragma once

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Turns closed components so that together they bound a solid: outward, and inward where a
// component lies inside an odd number of others, as the wall of a cavity does. Components with a
// border keep their side, which the scan's normals gave them; closed components without volume keep
// theirs, too. Components and borders are those of mesh_topology.h. Where surfaces pass through
// each other, the position of a component's first vertex decides. Indices are in range, coordinates
// finite. Near linear where few components lie behind each other.
void orient_outward(TriangleMesh& mesh);

}  // namespace emax
