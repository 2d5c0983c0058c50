#include <vtkDecimatePro.h>
#include <vtkNew.h>
#include <vtkQuadricDecimation.h>
#include <vtkVersion.h>

#include "host/geometry/bounds.h"
#include "host/vtk_stages/vtk_mesh.h"
#include "tests/benchmarks/decimation/tool.h"
#include "tests/benchmarks/quadric.h"

namespace emax::benchmarks {
namespace {

// What the filters share: the start in VTK's form.
struct Start {
  explicit Start(const TriangleMesh& mesh)
      : data(to_vtk(mesh)),
        midpoint(bounds_of(mesh.vertices).midpoint()),
        triangles(static_cast<double>(mesh.triangles.size())) {}

  template <class Filter>
  TriangleMesh run(Filter& filter, double target) const {
    filter->SetInputData(data);
    filter->SetTargetReduction(1 - target / triangles);
    filter->Update();
    return mesh_of(filter->GetOutput(), midpoint);
  }

  vtkSmartPointer<vtkPolyData> data;
  Point midpoint;
  double triangles;
};

struct ProOptions {
  const char* name;
  bool topology, boundary, accumulate;
  double angle;
};

}  // namespace

Tool vtk_quadric_tool() {
  const auto sets = [](const TriangleMesh& mesh, double) {
    std::vector<OptionSet> all;
    for (const bool volume : {true, false}) {
      all.push_back({volume ? "VolumePreservation" : "standard", OptionSet::Parameter::kTriangles,
                     [=, start = Start(mesh)](double triangles) {
                       vtkNew<vtkQuadricDecimation> filter;
                       filter->SetVolumePreservation(volume);
                       return start.run(filter, triangles);
                     }});
    }
    return all;
  };
  return {"VTK quadric decimation", "vtk-quadric", vtkVersion::GetVTKVersion(), sets};
}

Tool vtk_decimate_pro_tool() {
  const auto sets = [](const TriangleMesh& mesh, double) {
    std::vector<OptionSet> all;
    for (const ProOptions& o : {
             ProOptions{"PreserveTopology, FeatureAngle 60", true, true, true, 60},
             {"PreserveTopology, FeatureAngle 30", true, true, true, 30},
             {"PreserveTopology, boundary kept, FeatureAngle 60", true, false, true, 60},
             {"PreserveTopology, local errors, FeatureAngle 60", true, true, false, 60},
             {"Splitting, FeatureAngle 60", false, true, true, 60},
             {"Splitting, boundary kept, FeatureAngle 60", false, false, true, 60},
         }) {
      all.push_back(
          {o.name, OptionSet::Parameter::kTriangles, [=, start = Start(mesh)](double triangles) {
             vtkNew<vtkDecimatePro> filter;
             filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
             filter->SetPreserveTopology(o.topology);
             filter->SetSplitting(!o.topology);
             filter->SetBoundaryVertexDeletion(o.boundary);
             filter->SetAccumulateError(o.accumulate);
             filter->SetFeatureAngle(o.angle);
             return start.run(filter, triangles);
           }});
    }
    return all;
  };
  return {"VTK DecimatePro", "vtk-pro", vtkVersion::GetVTKVersion(), sets};
}

}  // namespace emax::benchmarks
