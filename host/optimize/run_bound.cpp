#include "host/optimize/run_bound.h"

#include <utility>

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/joining_distance.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

bool closes_flat_holes(const OptimizeSettings& settings) {
  const bool closes = !settings.hole_reach || *settings.hole_reach > 0;
  return settings.features != kNoFeatures && closes && !settings.closed;
}

// With the standard thresholds, whatever the candidates have: all share one reference.
void close_flat_holes(ReferenceFit& fit, std::span<const Point> points, double epsilon,
                      const OptimizeSettings& settings) {
  const PlaneParts parts = find_plane_parts(points, epsilon, settings.jobs, [&] {
    if (settings.interrupted()) throw Interrupted{};
  });
  fit.on_planes = close_on_planes(fit.surface.mesh, parts,
                                  {epsilon, settings.hole_reach.value_or(epsilon), settings.jobs});
  fit.surface.mesh = std::exchange(fit.on_planes->mesh, {});
}

}  // namespace

DecimationBound decimation_bound(std::span<const Point> cloud, ErrorConstraint& constraint,
                                 const OptimizeSettings& settings, ReferenceFit* made) {
  DecimationBound bound;
  if (!takes_bound(settings.decimator)) return bound;
  const bool two_sided = settings.epsilon_back.has_value();
  // Storing moves vertices, and with them both distances.
  const TriangleMesh box{{cloud.begin(), cloud.end()}, {}};
  const double moved = 2 * storage_displacement(box, storage_of(mesh_format(settings.output)));
  bound.epsilon = constraint.provable_distance() - moved;
  if (two_sided) bound.epsilon_back = *settings.epsilon_back - moved;
  if (bound.epsilon <= 0 || (two_sided && bound.epsilon_back <= 0)) {
    throw Error(settings.output.string() +
                ": the tolerance is lost where this format rounds; write .ply, .obj or .off");
  }
  const bool fitted = settings.method == kFitMethod;
  if (!two_sided && !fitted && constraint.excludable() == 0) return bound;

  ReferenceFit fit = fit_reference(cloud, bound.epsilon, settings);
  if (settings.closed) {
    ClosedSurface closed = close_surface(std::move(fit.surface.mesh));
    fit.surface.mesh = std::move(closed.mesh);
    fit.closed_holes = closed.closed;
    fit.open = std::move(closed.open);
  }
  const auto beyond = [&](const TriangleMesh& mesh) {
    return constraint.excludable() > 0
               ? constraint.measure(mesh.view(), settings.interrupted).excluded
               : std::vector<std::uint32_t>{};
  };
  bound.outliers = beyond(fit.surface.mesh);
  if (closes_flat_holes(settings)) {
    close_flat_holes(fit, points_without(cloud, bound.outliers), bound.epsilon, settings);
  }
  fit.joined_beyond = joining_distance(fit.best().within_half, bound.epsilon);
  ReferenceSurface joined =
      reference_surface(fit.surface.mesh, points_without(cloud, bound.outliers), fit.joined_beyond,
                        settings.interrupted);
  bound.reference = std::move(joined.mesh);
  bound.made_by = surface_key(fit.chain(settings.decimator));
  fit.joined = joined.inserted;
  fit.left_out = joined.left_out.size();
  if (settings.interrupted()) throw Interrupted{};
  // Also what could not be inserted, but no more what an insertion came near.
  bound.outliers = beyond(bound.reference);
  if (!two_sided && !fitted) bound.reference = {};
  if (made != nullptr) *made = std::move(fit);
  return bound;
}

}  // namespace emax
