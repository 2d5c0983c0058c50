#include <emax/certify.h>

#include <cmath>

#include "sw_model/base/public_arguments.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {
inline namespace v1 {

CertifiedPoints certify_points(Coordinates cloud, SurfaceSpan mesh, std::size_t threads) {
  require_no_flush_of_caller();
  if (threads == 0) throw Error("threads: at least one");
  const OwnedSurface surface = checked_surface(mesh, "mesh");
  const CertifiedError error = certify(checked_points(cloud, "cloud"), surface.view(), {}, threads);
  return {error.e_max_lower, error.e_max_upper, error.worst_point};
}

CertifiedDistance certify_distance(SurfaceSpan from, SurfaceSpan to, double relative) {
  require_no_flush_of_caller();
  if (!(relative >= 0)) throw Error("relative: a number of at least 0");
  const OwnedSurface mesh = checked_surface(from, "from"), reference = checked_surface(to, "to");
  SurfaceDistanceOptions options;
  options.relative = relative;
  const SurfaceDistance found = surface_distance(mesh.view(), ExactMesh(reference.view()), options);
  return {found.lower,
          found.upper,
          {found.witness.x(), found.witness.y(), found.witness.z()},
          found.triangle};
}

bool certify_within(SurfaceSpan from, SurfaceSpan to, double limit) {
  require_no_flush_of_caller();
  if (!(limit >= 0) || std::isinf(limit)) throw Error("limit: a finite number of at least 0");
  const OwnedSurface mesh = checked_surface(from, "from"), reference = checked_surface(to, "to");
  return decided_distance(mesh.view(), ExactMesh(reference.view()), limit).within(limit);
}

}  // namespace v1
}  // namespace emax
