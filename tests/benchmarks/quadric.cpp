#include "tests/benchmarks/quadric.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkQuadricDecimation.h>

#include "host/geometry/bounds.h"
#include "host/surface/mesh_orientation.h"
#include "host/vtk_stages/vtk_mesh.h"

namespace emax::benchmarks {

TriangleMesh mesh_of(vtkPolyData* data, const Point& midpoint) {
  TriangleMesh result;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    result.vertices.push_back(Point(data->GetPoint(i)) + midpoint);
  }
  vtkIdType corners = 0;
  const vtkIdType* ids = nullptr;
  for (vtkIdType cell = 0; cell < data->GetPolys()->GetNumberOfCells(); ++cell) {
    data->GetPolys()->GetCellAtId(cell, corners, ids);
    const auto index = [&](int k) { return static_cast<std::uint32_t>(ids[k]); };
    result.triangles.push_back({index(0), index(1), index(2)});
  }
  drop_unused(result);
  return result;
}

TriangleMesh decimate_quadric(const TriangleMesh& mesh, std::size_t triangles) {
  vtkNew<vtkQuadricDecimation> filter;
  filter->SetInputData(to_vtk(mesh));
  filter->SetTargetReduction(1 - static_cast<double>(triangles) /
                                     static_cast<double>(mesh.triangles.size()));
  filter->Update();
  return mesh_of(filter->GetOutput(), bounds_of(mesh.vertices).midpoint());
}

}  // namespace emax::benchmarks
