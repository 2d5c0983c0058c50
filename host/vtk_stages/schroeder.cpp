// Schroeder's decimation through vtkDecimatePro (paper, section 2.2 and [6]).
#include <vtkDecimatePro.h>
#include <vtkNew.h>

#include "host/parameters/registry.h"
#include "host/vtk_stages/vtk_mesh.h"
#include "sw_model/base/error.h"

namespace emax {

TriangleMesh Schroeder::run(const TriangleMesh& mesh, const ParameterValues& values) {
  vtkNew<vtkDecimatePro> filter;
  filter->SetInputData(to_vtk(mesh));
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->SetTargetReduction(values.at(kReduction));
  filter->SetFeatureAngle(values.at(kFeatureAngle));
  filter->SetAccumulateError(values.at(kAccumulateError));
  filter->SetPreserveTopology(values.at(kPreserveTopology));
  filter->SetSplitting(values.at(kSplitting));
  filter->SetBoundaryVertexDeletion(values.at(kBoundaryVertexDeletion));
  filter->Update();
  TriangleMesh result = from_vtk(filter->GetOutput(), mesh);
  if (result.triangles.empty()) {
    throw Error("decimation left no triangle; lower schroeder.reduction");
  }
  return result;
}

}  // namespace emax
