#include <vtkFillHolesFilter.h>
#include <vtkNew.h>

#include "host/geometry/bounds.h"
#include "host/vtk_stages/vtk_mesh.h"
#include "host/vtk_stages/vtk_stages.h"

namespace emax {

TriangleMesh fill_holes(const TriangleMesh& mesh, double size) {
  if (!(size > 0) || mesh.triangles.empty()) return mesh;
  vtkNew<vtkFillHolesFilter> filter;
  filter->SetInputData(to_vtk(mesh));
  filter->SetHoleSize(size * bounds_of(mesh.vertices).width());
  filter->Update();
  return from_vtk(filter->GetOutput(), mesh);
}

}  // namespace emax
