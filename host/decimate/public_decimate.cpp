#include <emax/decimate.h>

#include "host/decimate/certified_decimation.h"
#include "host/decimate/joining_distance.h"
#include "host/geometry/merge_vertices.h"
#include "sw_model/base/public_arguments.h"

namespace emax {
inline namespace v1 {
namespace {

DecimationSettings::Effort effort_of(DecimateOptions::Effort effort) {
  switch (effort) {
    case DecimateOptions::Effort::kCollapse:
      return DecimationSettings::Effort::kCollapse;
    case DecimateOptions::Effort::kNormal:
      return DecimationSettings::Effort::kRelax;
    default:
      return DecimationSettings::Effort::kDeep;
  }
}

Decimation decimate(OwnedSurface given, const std::vector<Point>& cloud,
                    const DecimateOptions& options) {
  require_no_flush_of_caller();
  if (!(options.max_error > 0)) throw Error("max_error: a positive number");
  if (!(options.max_back_error >= 0)) throw Error("max_back_error: a number of at least 0");
  if (options.threads == 0) throw Error("threads: a number of at least 1");
  if (!(options.feature_angle >= 0)) throw Error("feature_angle: a number of at least 0");
  CertifiedDecimationSettings settings;
  settings.decimation.epsilon = options.max_error;
  settings.decimation.epsilon_back = options.max_back_error;
  settings.decimation.two_sided = options.two_sided;
  settings.decimation.effort = effort_of(options.effort);
  settings.decimation.feature_angle = options.feature_angle;
  settings.decimation.threads = options.threads;
  settings.decimation.interrupted = options.interrupted;
  settings.decimation.advanced = options.progress;

  TriangleMesh mesh = {std::move(given.vertices), std::move(given.triangles)};
  drop_unused_vertices(mesh.vertices, mesh.triangles);
  const JoiningDistance far = joining_distance(mesh, cloud, options.max_error, options.interrupted);
  const ReferenceSurface reference = reference_surface(mesh, cloud, far, options.interrupted);
  const CertifiedDecimation made = decimate_certified(reference.mesh, cloud, settings);
  Decimation result;
  result.surface = as_public(made.mesh.view());
  result.e_max = made.points.e_max_upper;
  if (made.mesh_to_reference) result.to_reference = made.mesh_to_reference->upper;
  if (made.reference_to_mesh) result.from_reference = made.reference_to_mesh->upper;
  result.left_out.assign(made.points.excluded.begin(), made.points.excluded.end());
  result.interrupted = made.interrupted;
  return result;
}

}  // namespace

Decimation decimate(SurfaceSpan mesh, const DecimateOptions& options) {
  OwnedSurface given = checked_surface(mesh, "mesh");
  const std::vector<Point> cloud = given.vertices;
  return decimate(std::move(given), cloud, options);
}

Decimation decimate(SurfaceSpan mesh, Coordinates cloud, const DecimateOptions& options) {
  return decimate(checked_surface(mesh, "mesh"), checked_points(cloud, "cloud"), options);
}

}  // namespace v1
}  // namespace emax
