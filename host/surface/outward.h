#pragma once

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Turns closed components so that together they bound a solid: outward, and inward where one lies
// inside an odd number of others, as the wall of a cavity does. Components with a border stay as
// they are, on the side that the scan's normals gave them; so does a closed one without volume.
// Components and borders are those of mesh_topology.h. Surfaces that pass through each other are
// turned as the places of their first vertices ask. Indices are in range, coordinates finite.
//
// Near linear, where few components lie behind each other.
void orient_outward(TriangleMesh& mesh);

}  // namespace emax
