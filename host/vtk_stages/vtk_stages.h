#pragma once

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter_spec.h"

namespace emax {

// Closes holes whose circumscribed sphere has a radius of at most `size` times the mesh's width,
// through VTK (paper, section 2.2). No vertex is added. size = 0 returns the mesh as it is.
TriangleMesh fill_holes(const TriangleMesh& mesh, double size);

// Schroeder's decimation through vtkDecimatePro (paper, section 2.2 and [6]). `values` holds every
// parameter of decimation_parameters("schroeder"); others are ignored. The vertices that remain are
// vertices of the mesh given. Throws Error when nothing is left.
TriangleMesh decimate_schroeder(const TriangleMesh& mesh, const ParameterValues& values);

}  // namespace emax
