#include "host/chain/chain.h"

#include <chrono>

#include "host/chain/fill_holes_smoothly.h"
#include "host/geometry/scan_estimate.h"
#include "host/reconstruct/moving_least_squares.h"
#include "host/surface/crack_free.h"
#include "host/surface/cracks.h"
#include "host/surface/manifold_part.h"
#include "host/surface/outward.h"
#include "host/vtk_stages/vtk_stages.h"
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

FillMethod fill_method(const ParameterValues& values) {
  const auto chosen = values.find(kFillMethod);
  return chosen == values.end() ? FillMethod::kFlat : static_cast<FillMethod>(chosen->second);
}

// As the paper's chain does it.
TriangleMesh fill(const TriangleMesh& mesh, const ParameterValues& values) {
  const FillMethod method = fill_method(values);
  if (method == FillMethod::kNone) return mesh;
  const double size = values.at("fill.size");
  return method == FillMethod::kFlat ? fill_holes(mesh, size) : fill_holes_smoothly(mesh, size);
}

// A surface, with the cracks closed that reconstruction leaves and making it a surface; a hole of
// the scan stays.
TriangleMesh closed_surface(const TriangleMesh& mesh, const ChainSettings& settings,
                            const BoundedStage& bounded, double spacing) {
  const FillMethod method = fill_method(settings.parameters);
  if (method == FillMethod::kNone) return bounded.without_needless(manifold_part(mesh).mesh);
  const double size = settings.parameters.at("fill.size");
  return crack_free_surface(method == FillMethod::kSmooth ? fill_holes_smoothly(mesh, size) : mesh,
                            bounded.kept(), bounded.far(), size, kCrackSpacings * spacing,
                            settings.method == kInterpolatingMethod)
      .mesh;
}

}  // namespace

Chain::Chain(std::vector<Point> points, DecimationBound bound, std::size_t cache_bytes)
    : points_(std::move(points)),
      bounded_(points_, std::move(bound)),
      clouds_(cache_bytes),
      reconstructions_(cache_bytes),
      surfaces_(cache_bytes) {}

std::span<const Point> Chain::cloud(const ChainSettings& settings) {
  const ParameterValues values = cloud_key(settings);
  const auto method = values.find("mls.method");
  if (method == values.end() || static_cast<MlsMethod>(method->second) == MlsMethod::kNone) {
    return points_;
  }
  return clouds_.get(values, [&] { return MovedCloud{on_least_squares_surface(points_, values)}; })
      .points;
}

const Reconstruction& Chain::reconstruct(const ChainSettings& settings, StageSeconds& seconds) {
  return reconstructions_.get(reconstruction_key(settings), [&] {
    Stopwatch watch;
    Reconstructed made{
        reconstruction_method(settings.method).reconstruct(cloud(settings), settings.parameters)};
    seconds.reconstruct = watch.lap();
    return made;
  });
}

double Chain::spacing() {
  if (!spacing_) spacing_ = estimate_scan(points_).spacing;
  return *spacing_;
}

const Chain::Surface& Chain::surface(const ChainSettings& settings, StageSeconds& seconds) {
  return surfaces_.get({surface_key(settings), settings.decimator}, [&] {
    if (settings.method == kFitMethod) {
      const TriangleMesh& reference = bounded_.reference();
      return Surface{reference, reference.triangles.size(), 0, {}};
    }
    const Reconstruction& reconstruction = reconstruct(settings, seconds);
    Stopwatch watch;
    const bool surface = settings.decimator != "schroeder";
    TriangleMesh filled = surface
                              ? closed_surface(reconstruction.mesh, settings, bounded_, spacing())
                              : fill(reconstruction.mesh, settings.parameters);
    SurfaceVerdict verdict;
    if (settings.decimator == "bounded") {
      filled = bounded_.start(filled);
      verdict = bounded_.judge(filled);
    }
    if (surface) orient_outward(filled);
    seconds.prepare = watch.lap();
    return Surface{std::move(filled), reconstruction.mesh.triangles.size(),
                   reconstruction.unmeshed_points, verdict};
  });
}

ChainResult Chain::run(const ChainSettings& settings, const std::function<bool()>& stopped) {
  for (const ParameterSpec& spec : required_parameters(settings)) {
    if (!settings.parameters.contains(spec.name)) {
      throw Error("the parameter " + spec.name + " has no value");
    }
  }
  ChainResult result;
  const Surface& start = surface(settings, result.seconds);
  result.reconstruction_triangles = start.reconstruction_triangles;
  result.unmeshed_points = start.unmeshed_points;
  Stopwatch watch;
  if (settings.decimator == "bounded") {
    // Decimation mends neither a bound nor the topology.
    const bool hopeful = bounded_.keeps_bounds(start.verdict);
    if (hopeful) {
      DecimatedMesh decimated = bounded_.decimate(start.mesh, settings.parameters, stopped);
      result.mesh = std::move(decimated.mesh);
      result.stopped = decimated.interrupted;
    } else {
      result.mesh = start.mesh;
    }
    result.seconds.decimate = watch.lap();
    const SurfaceVerdict verdict = hopeful ? bounded_.judge(result.mesh) : start.verdict;
    result.topology_difference = verdict.topology_difference;
    result.back_distance = verdict.back_distance;
    result.reference_distance = verdict.reference_distance;
    result.seconds.check = watch.lap();
  } else if (settings.decimator == kNoDecimator) {
    result.mesh = start.mesh;
  } else {
    result.mesh = decimate_schroeder(start.mesh, settings.parameters);
    result.seconds.decimate = watch.lap();
  }
  return result;
}

}  // namespace emax
