#include "host/reconstruct/reconstruction.h"

#include <pcl/console/print.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "host/parameters/descriptions.h"
#include "host/reconstruct/local_cloud.h"
#include "host/surface/mesh_orientation.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// GP3 strings triangles without area along collinear points.
bool spans_area(const TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    if ((b - a).cross(c - a).squaredNorm() > 0) return true;
  }
  return false;
}

}  // namespace

Reconstruction reconstruct(std::string_view method, std::span<const Point> points,
                           const ParameterValues& values, std::size_t threads) {
  const MethodDescription& description = method_named(method);
  values.require(description.parameters);
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const LocalCloud cloud(points);
  Reconstruction result =
      std::ranges::find(method_runs(), method, &MethodRun::name)->run(cloud, values, threads);
  drop_unused(result.mesh);
  if (!spans_area(result.mesh)) {
    throw Error("the method " + description.name + " made no triangle with an area from " +
                std::to_string(points.size()) + " points; are they on one line? otherwise " +
                std::string(description.remedy));
  }
  return result;
}

}  // namespace emax
