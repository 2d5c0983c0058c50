#include "host/reconstruct/reconstruction.h"

#include <pcl/console/print.h>

#include <Eigen/Geometry>

#include "host/parameters/reconstruction_parameters.h"
#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/methods.h"
#include "host/surface/mesh_orientation.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

std::string_view remedy(std::string_view method) {
  if (method == "gp3") return "raise gp3.radius or gp3.mu";
  if (method == "poisson") return "change poisson.depth or take another method";
  if (method == "imls") return "raise imls.reach or lower imls.cell";
  return "raise hoppe.reach or lower hoppe.resolution";
}

// GP3 strings triangles without area along collinear points.
bool spans_area(const TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    if ((b - a).cross(c - a).squaredNorm() > 0) return true;
  }
  return false;
}

}  // namespace

std::span<const ParameterSpec> ReconstructionMethod::parameters() const {
  return reconstruction_parameters(name());
}

Reconstruction ReconstructionMethod::reconstruct(std::span<const Point> points,
                                                 const ParameterValues& values) const {
  for (const ParameterSpec& spec : parameters()) {
    if (!values.contains(spec.name)) throw Error("the parameter " + spec.name + " has no value");
  }
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const LocalCloud cloud(points);
  Reconstruction result = run(cloud, values);
  drop_unused(result.mesh);
  if (!spans_area(result.mesh)) {
    throw Error("the method " + std::string(name()) + " made no triangle with an area from " +
                std::to_string(points.size()) + " points; are they on one line? otherwise " +
                std::string(remedy(name())));
  }
  return result;
}

const ReconstructionMethod& reconstruction_method(std::string_view name) {
  static const GreedyProjection gp3;
  static const PoissonSurface poisson;
  static const HoppeSurface hoppe;
  static const ImplicitSurface imls;
  reconstruction_parameters(name);  // refuses an unknown name
  if (name == gp3.name()) return gp3;
  if (name == poisson.name()) return poisson;
  if (name == imls.name()) return imls;
  return hoppe;
}

}  // namespace emax
