#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// A mesh as VTK is given it: 64-bit coordinates around the origin, because VTK's tolerances take no
// account of far-away coordinates, and every vertex's index as point data, which the filters hand
// on. `mesh` has at least one vertex.
vtkSmartPointer<vtkPolyData> to_vtk(const TriangleMesh& mesh);

// What a filter made of to_vtk(original), on the very vertices of the original: consistently
// oriented, without folds, unused vertices and triangles that repeat one.
TriangleMesh from_vtk(vtkPolyData* data, const TriangleMesh& original);

}  // namespace emax
