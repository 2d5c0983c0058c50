#pragma once

#include "host/geometry/triangle_mesh.h"

namespace emax::benchmarks {

// vtkQuadricDecimation down to about `triangles`; its vertices move off the original's.
TriangleMesh decimate_quadric(const TriangleMesh& mesh, std::size_t triangles);

}  // namespace emax::benchmarks
