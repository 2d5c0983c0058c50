#pragma once

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Closes holes whose circumscribed sphere has a radius of at most `size` times the mesh's width,
// through VTK (paper, section 2.2). No vertex is added. size = 0 returns the mesh as it is.
TriangleMesh fill_holes(const TriangleMesh& mesh, double size);

}  // namespace emax
