#include <vtkDecimatePro.h>
#include <vtkNew.h>

#include "host/vtk_stages/vtk_mesh.h"
#include "host/vtk_stages/vtk_stages.h"
#include "sw_model/base/error.h"

namespace emax {

TriangleMesh decimate_schroeder(const TriangleMesh& mesh, const ParameterValues& values) {
  const auto flag = [&](const char* name) { return values.at(name) != 0; };
  vtkNew<vtkDecimatePro> filter;
  filter->SetInputData(to_vtk(mesh));
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->SetTargetReduction(values.at("schroeder.reduction"));
  filter->SetFeatureAngle(values.at("schroeder.feature_angle"));
  filter->SetAccumulateError(flag("schroeder.accumulate_error"));
  filter->SetPreserveTopology(flag("schroeder.preserve_topology"));
  filter->SetSplitting(flag("schroeder.splitting"));
  filter->SetBoundaryVertexDeletion(flag("schroeder.boundary_vertex_deletion"));
  filter->Update();
  TriangleMesh result = from_vtk(filter->GetOutput(), mesh);
  if (result.triangles.empty()) {
    throw Error("decimation left no triangle; lower schroeder.reduction");
  }
  return result;
}

}  // namespace emax
