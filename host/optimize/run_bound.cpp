#include "host/optimize/run_bound.h"

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/manifold_part.h"
#include "host/reconstruct/reconstruction_parameters.h"
#include "host/worker/worker_pool.h"
#include "sw_model/error.h"

namespace emax {
namespace {

TriangleMesh standard_surface(std::span<const Point> cloud, double epsilon,
                              const OptimizeSettings& settings) {
  WorkerPoolOptions options = worker_pool_options(cloud.size(), settings);
  options.jobs = 1;
  WorkerPool pool(cloud, {epsilon, 0, {}, {}}, options);
  // Of all methods the first, which follows the points most closely.
  const std::string method = settings.method == kAutoMethod
                                 ? std::string(reconstruction_methods().front())
                                 : settings.method;
  pool.submit(0, {method, kNoDecimator, standard_values(chain_parameters(method, kNoDecimator))});
  Completed completed = wait_for_next(pool, settings);
  if (const auto* failure = std::get_if<Failure>(&completed.outcome)) {
    const bool limited = failure->reason == FailureReason::kTimedOut ||
                         failure->reason == FailureReason::kOutOfMemory;
    throw Error("no reference surface could be made of the cloud: " + failure->message +
                (limited ? "; allow more with --evaluation-time or --evaluation-memory"
                         : "; take another --method, or --bound one-sided"));
  }
  return std::move(std::get<ChainResult>(completed.outcome).mesh);
}

}  // namespace

DecimationBound decimation_bound(std::span<const Point> cloud, ErrorConstraint& constraint,
                                 const OptimizeSettings& settings) {
  DecimationBound bound;
  if (settings.decimator == "schroeder") return bound;
  const bool two_sided = settings.epsilon_back.has_value();
  // Storing moves vertices, and with them both distances.
  const TriangleMesh box{{cloud.begin(), cloud.end()}, {}};
  const double moved = 2 * storage_displacement(box, mesh_format(settings.output));
  bound.epsilon = constraint.provable_distance() - moved;
  if (two_sided) bound.epsilon_back = *settings.epsilon_back - moved;
  if (bound.epsilon <= 0 || (two_sided && bound.epsilon_back <= 0)) {
    throw Error(settings.output.string() +
                ": the tolerance is lost where this format rounds; write .ply, .obj or .off");
  }
  if (!two_sided && constraint.excludable() == 0) return bound;

  const TriangleMesh surface = manifold_part(standard_surface(cloud, bound.epsilon, settings)).mesh;
  if (surface.triangles.empty()) {
    throw Error("the cloud's reconstruction has no part that is a surface; take another --method");
  }
  const auto beyond = [&](const TriangleMesh& mesh) {
    return constraint.excludable() > 0
               ? constraint.measure(mesh.view(), settings.interrupted).excluded
               : std::vector<std::uint32_t>{};
  };
  bound.outliers = beyond(surface);
  bound.reference = reference_surface(surface, points_without(cloud, bound.outliers),
                                      bound.epsilon / 2, settings.interrupted)
                        .mesh;
  if (settings.interrupted()) throw Interrupted{};
  // Also what could not be inserted, but no more what an insertion came near.
  bound.outliers = beyond(bound.reference);
  if (!two_sided) bound.reference = {};
  return bound;
}

}  // namespace emax
