#include "host/chain/chain.h"

#include <algorithm>
#include <chrono>

#include "host/chain/decimator_run.h"
#include "host/chain/fill_holes_smoothly.h"
#include "host/geometry/scan_estimate.h"
#include "host/parameters/descriptions.h"
#include "host/reconstruct/moving_least_squares.h"
#include "host/surface/crack_free.h"
#include "host/surface/cracks.h"
#include "host/surface/manifold_part.h"
#include "host/surface/outward.h"
#include "host/vtk_stages/vtk_stages.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// Since it was made or last asked.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> took = now - std::exchange(last_, now);
    return took.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// As the paper's chain does it.
TriangleMesh fill(const TriangleMesh& mesh, const ParameterValues& values) {
  const Fill::Method method = Fill::method(values);
  if (method == Fill::Method::kNone) return mesh;
  const double size = values.at(Fill::kSize);
  return method == Fill::Method::kFlat ? fill_holes(mesh, size) : fill_holes_smoothly(mesh, size);
}

// A surface, with the cracks closed that reconstruction leaves and making it a surface; a hole of
// the scan stays.
TriangleMesh closed_surface(const TriangleMesh& mesh, const ChainSettings& settings,
                            const BoundedStage& bounded, double spacing) {
  const Fill::Method method = Fill::method(settings.parameters);
  if (method == Fill::Method::kNone) return bounded.without_needless(manifold_part(mesh).mesh);
  const double size = settings.parameters.at(Fill::kSize);
  return crack_free_surface(
             method == Fill::Method::kSmooth ? fill_holes_smoothly(mesh, size) : mesh,
             bounded.kept(), bounded.far(), size, kCrackSpacings * spacing,
             method_named(settings.method).interpolates)
      .mesh;
}

}  // namespace

Chain::Chain(std::vector<Point> points, DecimationBound bound, std::size_t cache_bytes)
    : points_(std::move(points)),
      bounded_(points_, std::move(bound)),
      clouds_(cache_bytes),
      reconstructions_(cache_bytes),
      surfaces_(cache_bytes),
      planes_(cache_bytes) {}

std::span<const Point> Chain::cloud(const ChainSettings& settings) {
  const ParameterValues values = cloud_key(settings);
  if (Mls::method(values) == Mls::Method::kNone) return points_;
  return clouds_.get(values, [&] { return MovedCloud{on_least_squares_surface(points_, values)}; })
      .points;
}

const Reconstruction& Chain::reconstruct(const ChainSettings& settings, StageSeconds& seconds,
                                         std::size_t threads) {
  return reconstructions_.get(reconstruction_key(settings), [&] {
    Stopwatch watch;
    Reconstructed made{
        emax::reconstruct(settings.method, cloud(settings), settings.parameters, threads)};
    seconds.reconstruct = watch.lap();
    return made;
  });
}

double Chain::spacing() {
  if (!spacing_) spacing_ = estimate_scan(points_).spacing;
  return *spacing_;
}

const Chain::Surface& Chain::surface(const ChainSettings& settings, StageSeconds& seconds,
                                     std::size_t threads) {
  return surfaces_.get({surface_key(settings), settings.decimator}, [&] {
    if (settings.method == kFitMethod || bounded_.made_reference(settings)) {
      const TriangleMesh& reference = bounded_.reference();
      return Surface{reference, reference.triangles.size(), 0, {}};
    }
    const Reconstruction& reconstruction = reconstruct(settings, seconds, threads);
    Stopwatch watch;
    const bool surface = takes_bound(settings.decimator);
    TriangleMesh filled = surface
                              ? closed_surface(reconstruction.mesh, settings, bounded_, spacing())
                              : fill(reconstruction.mesh, settings.parameters);
    SurfaceVerdict verdict;
    if (keeps_bound(settings.decimator)) {
      filled = bounded_.start(filled);
      verdict = bounded_.judge(filled);
    }
    if (surface) orient_outward(filled);
    seconds.prepare = watch.lap();
    return Surface{std::move(filled), reconstruction.mesh.triangles.size(),
                   reconstruction.unmeshed_points, verdict};
  });
}

std::size_t Chain::FoundPlanes::size_in_bytes() const {
  return parts->points.size() * (sizeof(Point) + sizeof(std::uint32_t)) +
         parts->planes.size() * sizeof(Plane) + parts->curved.size() * sizeof(Shape) +
         parts->support.size() * sizeof(PlaneParts::Support);
}

std::shared_ptr<const PlaneParts> Chain::planes(const ChainSettings& settings,
                                                std::size_t threads) {
  const ParameterValues key = features_key(settings);
  if (key.by_name().empty()) return nullptr;
  return planes_
      .get(EMAX_FAULT(kForgetsThresholds) ? ParameterValues() : key,
           [&] {
             const PlaneThresholds thresholds = {
                 key.at(PlaneFeatures::kBand),
                 static_cast<std::size_t>(key.at(PlaneFeatures::kLeastPoints)),
                 PlaneFeatures::method(key) == PlaneFeatures::Method::kAll};
             return FoundPlanes{std::make_shared<const PlaneParts>(find_plane_parts(
                 bounded_.kept(), bounded_.bound().epsilon, threads, [] {}, thresholds))};
           })
      .parts;
}

ChainResult Chain::run(const ChainSettings& settings, const RunOptions& options) {
  require_values(settings);
  ChainResult result;
  const Surface& start = surface(settings, result.seconds, options.threads);
  result.reconstruction_triangles = start.reconstruction_triangles;
  result.unmeshed_points = start.unmeshed_points;
  Stopwatch watch;
  if (settings.decimator == kNoDecimator) {
    result.mesh = start.mesh;
    return result;
  }
  const bool bounded = keeps_bound(settings.decimator);
  // Decimation mends neither a bound nor the topology.
  const bool hopeful = !bounded || bounded_.keeps_bounds(start.verdict);
  if (hopeful) {
    const auto decimator =
        std::ranges::find(decimator_runs(), settings.decimator, &DecimatorRun::name);
    RunOptions own = options;
    if (bounded) own.planes = planes(settings, options.threads);
    DecimatedMesh decimated = decimator->run(start.mesh, settings.parameters, bounded_, own);
    result.mesh = std::move(decimated.mesh);
    result.stopped = decimated.interrupted;
    result.expected_triangles = decimated.expected;
  } else {
    result.mesh = start.mesh;
  }
  result.seconds.decimate = watch.lap();
  if (!bounded) return result;
  const SurfaceVerdict verdict = hopeful ? bounded_.judge(result.mesh) : start.verdict;
  result.topology_difference = verdict.topology_difference;
  result.back_distance = verdict.back_distance;
  result.reference_distance = verdict.reference_distance;
  result.seconds.check = watch.lap();
  return result;
}

}  // namespace emax
