#include "host/optimize/reference_fit.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "host/decimate/joining_distance.h"
#include "host/geometry/bounds.h"
#include "host/geometry/disjoint_sets.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/thinning.h"
#include "host/parameters/descriptions.h"
#include "host/surface/close_holes.h"
#include "host/surface/cracks.h"
#include "host/surface/outward.h"
#include "host/worker_pool/worker_pool.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr double kFill = 0.2;        // of the width: no crack's size is bounded by that
constexpr double kClean = 0.04;      // noise, in point spacings
constexpr double kFew = 0.002;       // share of the points that a good surface may leave,
constexpr double kMany = 0.02;       // and one that calls for another,
constexpr double kSlack = 1.5;       // beyond so many times what noise explains
constexpr std::size_t kRefined = 4;  // times as many points after a part was not enough

constexpr std::string_view kLastMethod = Poisson::kName;  // where the others have faults

bool interpolates(const ChainSettings& chain) { return method_named(chain.method).interpolates; }

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

// The share of the points that noise alone puts where points are joined.
double explained_by_noise(const TriedSurface& tried, const ScanEstimate& scan, double epsilon) {
  return std::erfc(joining_distance(tried.within_half, epsilon).with_others / scan.noise /
                   std::numbers::sqrt2);
}

class Fit {
 public:
  // `cloud` is what surfaces are made of, a part of `all`.
  Fit(std::span<const Point> cloud, std::span<const Point> all, double epsilon,
      const ScanEstimate& scan, const OptimizeSettings& settings)
      : cloud_(cloud),
        all_(all),
        epsilon_(epsilon),
        settings_(settings),
        scan_(cloud.size() < all.size() ? estimate_scan(cloud) : scan) {
    fit_.scan = scan;
    fit_.made_of = cloud.size();
  }

  ReferenceFit run() {
    const std::vector<std::string> methods = candidates();
    WorkerPoolOptions options = worker_pool_options(cloud_.size(), settings_);
    options.jobs = std::min(settings_.jobs, static_cast<unsigned>(methods.size()));
    const std::unique_ptr<EvaluationPool> pool = settings_.make_pool(cloud_, {}, options);
    for (const std::string& method : methods) submit(*pool, method);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      take(*pool, m);
      if (!good(fit_.tried[m])) continue;
      fit_.tried.resize(m + 1);
      break;
    }
    choose();
    const bool may_choose = settings_.method == kFitMethod && settings_.reference_method.empty();
    if (may_choose && is_faulty(fit_.best())) {
      submit(*pool, std::string(kLastMethod));
      take(*pool, fit_.tried.size() - 1);
      choose();
    }
    if (!fit_.best().failure.empty()) {
      throw Error("no reference surface could be made of the cloud: " + fit_.best().failure);
    }
    fit_.surface = std::move(surfaces_[fit_.chosen]);
    return std::move(fit_);
  }

 private:
  std::vector<std::string> candidates() const {
    if (!settings_.reference_method.empty()) return {settings_.reference_method};
    if (settings_.method == kAutoMethod) return {reconstruction_methods().front().name};
    if (settings_.method != kFitMethod) return {settings_.method};
    std::string first = first_method(scan_);
    return {first, std::string(first == Gp3::kName ? Imls::kName : Gp3::kName)};
  }

  void submit(EvaluationPool& pool, const std::string& method) {
    TriedSurface tried;
    tried.chain = fitted_chain(method, scan_, bounds_of(cloud_).width());
    // The surface as it comes: what is done to it is to be known here.
    ChainSettings raw = tried.chain;
    raw.parameters.set(Fill::kMethod, Fill::Method::kNone);
    pool.submit({fit_.tried.size(), raw});
    fit_.tried.push_back(std::move(tried));
  }

  void take(EvaluationPool& pool, std::size_t m) {
    completed_.resize(fit_.tried.size());
    surfaces_.resize(fit_.tried.size());
    while (!completed_[m]) {
      Completed next = wait_for_next(pool, settings_);
      completed_[next.ticket] = std::move(next);
    }
    surfaces_[m] = judge(fit_.tried[m], std::move(completed_[m]->outcome));
  }

  void choose() {
    constexpr std::size_t kNone = ~std::size_t{0};
    MeshTopology least{kNone, kNone, kNone};
    for (const TriedSurface& tried : fit_.tried) {
      if (!tried.failure.empty()) continue;
      least.components = std::min(least.components, tried.topology.components);
      least.genus = std::min(least.genus, tried.topology.genus);
      // It bridges holes of the scan, so borders that it lacks count against it.
      if (tried.chain.method == kLastMethod) continue;
      least.border_loops = std::min(least.border_loops, tried.topology.border_loops);
    }
    for (TriedSurface& tried : fit_.tried) {
      if (!tried.failure.empty()) continue;
      tried.excess =
          tried.topology.components - least.components + tried.topology.genus - least.genus;
      if (least.border_loops == kNone) continue;
      const std::size_t borders = tried.topology.border_loops;
      tried.excess += std::max(borders, least.border_loops) - std::min(borders, least.border_loops);
    }
    for (std::size_t m = 0; m < fit_.tried.size(); ++m) {
      const TriedSurface& tried = fit_.tried[m];
      if (!tried.failure.empty()) continue;
      const bool better = !fit_.best().failure.empty() || tried.cost() < fit_.best().cost();
      if (better) fit_.chosen = m;
    }
  }

  bool is_faulty(const TriedSurface& tried) const {
    // Joined points that noise explains speak for no other surface.
    return !tried.failure.empty() || tried.cracks + tried.pieces > 0 ||
           tried.joined > kMany + kSlack * explained_by_noise(tried, fit_.scan, epsilon_);
  }

  bool good(const TriedSurface& tried) const {
    if (!tried.failure.empty()) return false;
    if (interpolates(tried.chain) && tried.topology.border_loops > 0) return false;
    return tried.cracks + tried.pieces == 0 && tried.joined <= kFew;
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
    const double crack = kCrackSpacings * scan_.spacing;
    CrackFreeSurface surface =
        crack_free_surface(std::move(std::get<ChainResult>(outcome).mesh), cloud_, epsilon_ / 2,
                           kFill, crack, interpolates(tried.chain));
    if (surface.mesh.triangles.empty()) {
      tried.failure =
          "the cloud's reconstruction has no part that is a surface; take another --method";
      return surface;
    }
    orient_outward(surface.mesh);
    tried.triangles = surface.mesh.triangles.size();
    tried.cracks = count_cracks(surface.mesh, crack);
    tried.topology = topology_of(surface.mesh.view());
    tried.pieces = small_pieces(surface.mesh);
    measure(surface.mesh, tried);
    return surface;
  }

  void measure(const TriangleMesh& mesh, TriedSurface& tried) const {
    const std::vector<double> distances =
        sampled_distances(mesh, all_, epsilon_ / 2, settings_.interrupted);
    if (distances.empty()) throw Interrupted{};
    tried.within_half = 1 - share_beyond(distances, epsilon_ / 2);
    tried.joined =
        share_beyond(distances, joining_distance(tried.within_half, epsilon_).with_others);
    tried.points = all_.size();
    // What interpolates the points has their noise.
    if (interpolates(tried.chain)) tried.roughness = scan_.noise / epsilon_;
  }

  std::span<const Point> cloud_, all_;
  double epsilon_;
  const OptimizeSettings& settings_;
  ScanEstimate scan_;  // of cloud_
  ReferenceFit fit_;
  std::vector<std::optional<Completed>> completed_;  // of what is tried
  std::vector<CrackFreeSurface> surfaces_;
};

// Whether so few points are far from the surface that more points would hardly make a better one.
bool holds_enough(const ReferenceFit& fit, double epsilon) {
  return fit.best().joined <= kFew + kSlack * explained_by_noise(fit.best(), fit.scan, epsilon);
}

}  // namespace

std::string first_method(const ScanEstimate& scan) {
  return std::string(scan.noise > kClean * scan.spacing ? Imls::kName : Gp3::kName);
}

ChainSettings fitted_chain(const std::string& method, const ScanEstimate& scan, double width) {
  ChainSettings chain{method, kNoDecimator,
                      ParameterValues(chain_parameters(method, kNoDecimator))};
  const double noise = scan.spacing > 0 ? scan.noise / scan.spacing : 0;
  if (method == Imls::kName) {
    constexpr double kSmooths = 8;  // radius that averages noise away, in its standard deviations
    constexpr auto kReach = Imls::kLeastReach;
    chain.parameters.set(kReach, std::clamp(kSmooths * noise, kReach.lower, kReach.upper));
    chain.parameters.set(Normals::kNeighbours, noise > 0.2 ? 30 : 20);
  }
  if (method == Poisson::kName && scan.spacing > 0) {
    // Cells of one to two spacings.
    const double depth = std::ceil(std::log2(1.1 * width / (2 * scan.spacing)));
    constexpr double kLeast = Poisson::kDepth.lower, kMost = Poisson::kDepth.upper;
    chain.parameters.set(Poisson::kDepth, static_cast<int>(std::clamp(depth, kLeast, kMost)));
  }
  return chain;
}

// About the triangles that it costs after decimation (docs/decisions/0014): of a point that is
// joined, of noise that is interpolated, of edges and borders that are rounded. A fault of topology
// costs more than that: it is no triangle that is one too many.
double TriedSurface::cost() const {
  constexpr double kFault = 1000, kJoined = 2, kRough = 1, kRounded = 0.02;
  const double own = interpolates(chain) ? kRough * std::min(1.0, roughness * roughness) : kRounded;
  return kFault * static_cast<double>(cracks + pieces + excess) +
         (kJoined * joined + own) * static_cast<double>(points);
}

ParameterValues ReferenceFit::fitted_values() const {
  ParameterValues values = best().chain.parameters;
  for (const Parameter& p : chain_parameters(best().chain.method, kNoDecimator)) {
    if (values.by_name().at(p.name) == p.standard) values.by_name().erase(p.name);
  }
  return values;
}

ChainSettings ReferenceFit::chain(const std::string& decimator) const {
  const ChainSettings& made = best().chain;
  ChainSettings whole{made.method, decimator,
                      ParameterValues(chain_parameters(made.method, decimator))};
  for (const auto& [name, value] : made.parameters.by_name()) {
    whole.parameters.by_name()[name] = value;
  }
  return whole;
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
  const ScanEstimate scan = estimate_scan(cloud);
  if (settings.method == kFitMethod && scan.spacing > 0) {
    for (std::size_t n = settings.reference_points; is_thinned(cloud.size(), n); n *= kRefined) {
      std::vector<Point> part;
      for (const std::uint32_t i : thinned(cloud, thinning_radius(scan.spacing, cloud.size(), n))) {
        part.push_back(cloud[i]);
      }
      ReferenceFit fit = Fit(part, cloud, epsilon, scan, settings).run();
      if (holds_enough(fit, epsilon)) return fit;
    }
  }
  return Fit(cloud, cloud, epsilon, scan, settings).run();
}

}  // namespace emax
