#pragma once

#include "host/geometry/triangle_mesh.h"

class vtkPolyData;

namespace emax::benchmarks {

// What a filter made of to_vtk() of a mesh with that midpoint; its vertices may be new ones.
TriangleMesh mesh_of(vtkPolyData* data, const Point& midpoint);

// vtkQuadricDecimation down to about `triangles`; its vertices move off the original's.
TriangleMesh decimate_quadric(const TriangleMesh& mesh, std::size_t triangles);

}  // namespace emax::benchmarks
