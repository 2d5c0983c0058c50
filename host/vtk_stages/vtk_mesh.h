#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// A mesh in VTK's form. Coordinates are 64-bit and moved to the origin, because VTK's tolerances do
// not allow for coordinates far away. Every vertex has its index as point data, which the filters
// pass on. `mesh` has at least one vertex.
vtkSmartPointer<vtkPolyData> to_vtk(const TriangleMesh& mesh);

// The result of a filter on to_vtk(original), with the exact vertices of the original: consistently
// oriented, without folds, without unused vertices and without triangles that repeat a vertex.
TriangleMesh from_vtk(vtkPolyData* data, const TriangleMesh& original);

}  // namespace emax
