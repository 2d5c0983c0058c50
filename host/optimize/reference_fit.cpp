#include "host/optimize/reference_fit.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/decimate/close_holes.h"
#include "host/decimate/cracks.h"
#include "host/geometry/bounds.h"
#include "host/geometry/disjoint_sets.h"
#include "host/geometry/mesh_topology.h"
#include "host/reconstruct/outward.h"
#include "host/reconstruct/reconstruction_parameters.h"
#include "host/worker/worker_pool.h"
#include "sw_model/error.h"
#include "sw_model/exact_distance.h"

namespace emax {
namespace {

constexpr double kFill = 0.2;              // of the width: no crack's size is bounded by that
constexpr double kClean = 0.04;            // noise, in point spacings
constexpr double kExplained = 3.5;         // standard deviations of noise
constexpr double kFew = 0.002;             // unexplained points that a good surface may leave
constexpr std::size_t kMeasured = 50'000;  // points whose distance is looked at

ChainSettings fitted_chain(const std::string& method, const ScanEstimate& scan, double width) {
  ChainSettings chain{method, kNoDecimator,
                      standard_values(chain_parameters(method, kNoDecimator))};
  const double noise = scan.spacing > 0 ? scan.noise / scan.spacing : 0;
  if (method == "imls") {
    constexpr double kSmooths = 8;  // radius that averages noise away, in its standard deviations
    const auto specs = reconstruction_parameters(method);
    const auto bounded = [&](const char* name, double value) {
      const auto spec = std::ranges::find(specs, name, &ParameterSpec::name);
      chain.parameters[name] = std::clamp(value, spec->lower, spec->upper);
    };
    bounded("imls.least_reach", kSmooths * noise);
    bounded("normals.k", noise > 0.2 ? 30 : 20);
  }
  if (method == "poisson" && scan.spacing > 0) {
    // Cells of one to two spacings.
    const double depth = std::ceil(std::log2(1.1 * width / (2 * scan.spacing)));
    chain.parameters["poisson.depth"] = std::clamp(depth, 6.0, 10.0);
  }
  return chain;
}

// Components of less than a share of the area.
std::size_t small_pieces(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  std::vector<double> areas(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[1], t[2]);
  }
  double all = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    const double area = 0.5 * (b - a).cross(c - a).norm();
    areas[sets.root(mesh.triangles[t][0])] += area;
    all += area;
  }
  return static_cast<std::size_t>(std::ranges::count_if(
      areas, [&](double area) { return area > 0 && area < kPieceOfArea * all; }));
}

class Fit {
 public:
  Fit(std::span<const Point> cloud, double epsilon, const OptimizeSettings& settings)
      : cloud_(cloud), epsilon_(epsilon), settings_(settings) {
    fit_.scan = estimate_scan(cloud);
  }

  ReferenceFit run() {
    const std::vector<std::string> methods = candidates();
    WorkerPoolOptions options = worker_pool_options(cloud_.size(), settings_);
    options.jobs = std::min(settings_.jobs, static_cast<unsigned>(methods.size()));
    WorkerPool pool(cloud_, {}, options);
    const double width = bounds_of(cloud_).width();
    for (std::size_t m = 0; m < methods.size(); ++m) {
      TriedSurface tried;
      tried.chain = fitted_chain(methods[m], fit_.scan, width);
      // The surface as it comes: what is done to it is to be known here.
      ChainSettings raw = tried.chain;
      raw.parameters[kFillMethod] = static_cast<double>(FillMethod::kNone);
      pool.submit(m, raw);
      fit_.tried.push_back(std::move(tried));
    }
    std::vector<std::optional<Completed>> completed(methods.size());
    std::vector<CrackFreeSurface> surfaces(methods.size());
    for (std::size_t m = 0; m < methods.size(); ++m) {
      while (!completed[m]) {
        Completed next = wait_for_next(pool, settings_);
        completed[next.ticket] = std::move(next);
      }
      surfaces[m] = judge(fit_.tried[m], std::move(completed[m]->outcome));
      if (!fit_.tried[m].failure.empty()) continue;
      if (good(fit_.tried[m])) {
        fit_.tried.resize(m + 1);
        break;
      }
    }
    choose();
    if (!fit_.best().failure.empty()) {
      throw Error("no reference surface could be made of the cloud: " + fit_.best().failure);
    }
    fit_.surface = std::move(surfaces[fit_.chosen]);
    return std::move(fit_);
  }

 private:
  std::vector<std::string> candidates() const {
    if (settings_.method == kAutoMethod) return {std::string(reconstruction_methods().front())};
    if (settings_.method != kFitMethod) return {settings_.method};
    if (fit_.scan.noise > kClean * fit_.scan.spacing) return {"imls", "gp3"};
    return {"gp3", "imls"};
  }

  void choose() {
    std::size_t least = ~std::size_t{0};
    for (const TriedSurface& tried : fit_.tried) {
      if (tried.failure.empty()) least = std::min(least, tried.borders);
    }
    for (std::size_t m = 0; m < fit_.tried.size(); ++m) {
      TriedSurface& tried = fit_.tried[m];
      if (!tried.failure.empty()) continue;
      tried.excess_borders = tried.borders - least;
      const bool better = !fit_.best().failure.empty() || tried.cost() < fit_.best().cost();
      if (better) fit_.chosen = m;
    }
  }

  bool good(const TriedSurface& tried) const {
    if (tried.chain.method == "gp3" && tried.borders > 0) return false;
    return tried.cracks == 0 && tried.pieces == 0 && tried.unexplained <= kFew;
  }

  CrackFreeSurface judge(TriedSurface& tried, std::variant<ChainResult, Failure> outcome) const {
    if (const auto* failure = std::get_if<Failure>(&outcome)) {
      const bool limited = failure->reason == FailureReason::kTimedOut ||
                           failure->reason == FailureReason::kOutOfMemory;
      tried.failure =
          failure->message + (limited ? "; allow more with --evaluation-time or --evaluation-memory"
                                      : "; take another --method, or --bound one-sided");
      return {};
    }
    const double crack = kCrackSpacings * fit_.scan.spacing;
    CrackFreeSurface surface = crack_free_surface(std::move(std::get<ChainResult>(outcome).mesh),
                                                  cloud_, epsilon_ / 2, kFill, crack);
    if (surface.mesh.triangles.empty()) {
      tried.failure =
          "the cloud's reconstruction has no part that is a surface; take another --method";
      return surface;
    }
    orient_outward(surface.mesh);
    tried.triangles = surface.mesh.triangles.size();
    tried.cracks = count_cracks(surface.mesh, crack);
    tried.borders = topology_of(surface.mesh.view()).border_loops;
    tried.pieces = small_pieces(surface.mesh);
    measure(surface.mesh, tried);
    return surface;
  }

  void measure(const TriangleMesh& mesh, TriedSurface& tried) const {
    const ExactMesh exact(mesh.view());
    const std::size_t step = (cloud_.size() + kMeasured - 1) / kMeasured;
    const double explained = std::max(epsilon_ / 2, kExplained * fit_.scan.noise);
    std::size_t points = 0, within = 0, unexplained = 0;
    for (std::size_t i = 0; i < cloud_.size(); i += step) {
      const double distance = exact.nearest(cloud_[i], epsilon_ / 2).distance.upper;
      ++points;
      if (distance <= epsilon_ / 2) ++within;
      if (distance > explained) ++unexplained;
      if (settings_.interrupted()) throw Interrupted{};
    }
    tried.within_half = static_cast<double>(within) / static_cast<double>(points);
    tried.unexplained = static_cast<double>(unexplained) / static_cast<double>(points);
    tried.points = cloud_.size();
    // What interpolates the points has their noise.
    if (tried.chain.method == "gp3" && fit_.scan.noise > kClean * fit_.scan.spacing) {
      tried.roughness = fit_.scan.noise / fit_.scan.spacing;
    }
  }

  std::span<const Point> cloud_;
  double epsilon_;
  const OptimizeSettings& settings_;
  ReferenceFit fit_;
};

}  // namespace

double TriedSurface::cost() const {
  constexpr double kFault = 100, kPoint = 0.1, kRough = 0.5;
  return kFault * static_cast<double>(cracks + pieces + excess_borders) +
         (kPoint * unexplained + kRough * roughness) * static_cast<double>(points);
}

std::string describe(const TriedSurface& tried) {
  const auto count = [](std::size_t n, const char* what) {
    return (n == 0 ? "no" : std::to_string(n)) + " " + what + (n == 1 ? "" : "s");
  };
  return fmt::format(
      "{}{}, {:.4g}% of the points within half of the tolerance", count(tried.cracks, "crack"),
      tried.pieces > 0 ? ", " + count(tried.pieces, "small piece") : "", 100 * tried.within_half);
}

ReferenceFit fit_reference(std::span<const Point> cloud, double epsilon,
                           const OptimizeSettings& settings) {
  return Fit(cloud, epsilon, settings).run();
}

}  // namespace emax
