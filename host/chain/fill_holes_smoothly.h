#pragma once

#include "host/geometry/triangle_mesh.h"

namespace emax {

// As fill_holes, and the patches then have new vertices (paper, section 2.2 and [4], [5]): their
// edges are halved until they are about as long as those around the hole, and every new vertex is
// moved onto the moving least squares surface of the mesh's vertices around the hole. Triangles of
// the mesh stay as they are. `size` is a share of the mesh's width; a patch is refined up to 20,000
// triangles, in O(triangles of the patch * vertices around the hole).
TriangleMesh fill_holes_smoothly(const TriangleMesh& mesh, double size);

}  // namespace emax
