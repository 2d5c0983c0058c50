#include "host/vtk_stages/vtk_mesh.h"

#include <vtkCellArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <stdexcept>

#include "host/geometry/bounds.h"
#include "host/surface/mesh_orientation.h"

namespace emax {
namespace {

constexpr const char* kVertexIndex = "vertex index";

std::uint32_t narrow(vtkIdType id) { return static_cast<std::uint32_t>(id); }

}  // namespace

vtkSmartPointer<vtkPolyData> to_vtk(const TriangleMesh& mesh) {
  vtkObject::GlobalWarningDisplayOff();
  const Point midpoint = bounds_of(mesh.vertices).midpoint();
  const auto count = static_cast<vtkIdType>(mesh.vertices.size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  vtkNew<vtkIdTypeArray> indices;
  indices->SetName(kVertexIndex);
  indices->SetNumberOfValues(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const Point local = mesh.vertices[static_cast<std::size_t>(i)] - midpoint;
    points->SetPoint(i, local.data());
    indices->SetValue(i, i);
  }
  vtkNew<vtkCellArray> cells;
  for (const Triangle& t : mesh.triangles) cells->InsertNextCell({t[0], t[1], t[2]});
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->AddArray(indices);
  return data;
}

TriangleMesh from_vtk(vtkPolyData* data, const TriangleMesh& original) {
  const auto* indices =
      vtkIdTypeArray::SafeDownCast(data->GetPointData()->GetAbstractArray(kVertexIndex));
  if (indices == nullptr) throw std::logic_error("a VTK filter dropped its point data");
  TriangleMesh mesh;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    mesh.vertices.push_back(original.vertices[narrow(indices->GetValue(i))]);
  }
  vtkIdType corners = 0;
  const vtkIdType* ids = nullptr;
  vtkCellArray* cells = data->GetPolys();
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell) {
    cells->GetCellAtId(cell, corners, ids);
    if (corners != 3) throw std::logic_error("a VTK filter made a polygon of more than 3 corners");
    mesh.triangles.push_back({narrow(ids[0]), narrow(ids[1]), narrow(ids[2])});
  }
  drop_folds(mesh);
  orient_consistently(mesh);
  drop_unused(mesh);
  return mesh;
}

}  // namespace emax
