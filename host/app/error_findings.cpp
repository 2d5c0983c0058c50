#include "host/app/error_findings.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>

#include "host/app/device_report.h"
#include "host/measure/point_distances.h"
#include "host/report/point_store.h"
#include "host/report/surface_samples.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kSurfaceSamples = 100000;
// Relative precision of the greatest distance of the mesh from its reference.
constexpr double kSurfacePrecision = 1e-3;
constexpr double kFinest = 1e-6;  // of the width: the precision where the distance is near 0
constexpr double kDecisionPrecision = 1e-9;

// The points of a cloud measured piece by piece: by the kernel, and certified. A distance that is
// printed, or that may lie on the other side of the limit, is the exact one.
class CloudMeasurement {
 public:
  CloudMeasurement(const ScanPieces& scan, const MeasuredMesh& mesh, const ErrorQuestion& question,
                   std::optional<double> limit)
      : scan_(scan),
        question_(question),
        limit_(limit),
        excludable_(excludable_points(question.excluded_share, scan.points())),
        meter_(meter_of(scan, mesh, nullptr,
                        {.brute_force = question.brute_force,
                         .memory = question.memory / 8,
                         .interrupted = question.interrupted,
                         .advance = question.advance})),
        extent_(meter_->extent()),
        margin_(limit ? point_distance_margin(scan.normalization(), extent_, *limit) : 0),
        farthest_(excludable_),
        store_(scan.points(), question.memory / 4, scan.scan().path.string()) {}

  const PieceMeter& meter() const { return *meter_; }
  const MeshExtent& extent() const { return extent_; }
  std::size_t excludable() const { return excludable_; }
  const FarthestPoints& farthest() const { return farthest_; }
  // Of the kernel alone, on all threads together.
  double kernel_seconds() const {
    if (const PartwiseDistances* parts = meter_->parts()) {
      return parts->kernel_seconds() / static_cast<double>(processor_threads());
    }
    const std::size_t shared = runner().threads(scan_.scan().path, question_.files);
    const std::size_t threads = std::min(std::max(processor_threads(), shared), pieces_done_);
    return kernel_seconds_ / static_cast<double>(threads);
  }

  void measure() {
    PieceQuestion asked;
    asked.distances = true;
    asked.certify = excludable_ == 0;
    asked.limit = limit_;
    asked.margin = margin_;
    // At least one, even if none is to be shown: it gives the maximum.
    asked.farthest = std::max<std::size_t>(question_.worst, 1);
    run(asked, [&](const PieceFindings& found) { add(found, asked.farthest); });
  }

  // `excluded`: numbers of points, ascending.
  CertifiedError certify(std::span<const std::uint32_t> excluded) {
    if (excludable_ > 0) {
      PieceQuestion asked;
      asked.excluded.assign(excluded.begin(), excluded.end());
      run(asked, [](const PieceFindings&) {});
    }
    return meter_->certified();
  }

  CloudErrors errors(const std::vector<double>& quantiles) {
    std::vector<FarPoint> worst;
    for (const FarthestPoint& shown : shown_) {
      const ExactMesh::Nearest nearest = meter_->nearest(shown.at, shown.index);
      store_.put(shown.index, {&nearest.distance.upper, 1});
      worst.push_back({shown.number, shown.at, nearest.distance.upper, nearest.triangle});
    }
    std::ranges::stable_sort(
        worst, [](const FarPoint& a, const FarPoint& b) { return a.distance > b.distance; });
    worst.resize(std::min(question_.worst, worst.size()));
    const auto all = [this](const auto& take) { store_.read(take); };
    return {statistics_of(all, quantiles, limit_), std::move(worst)};
  }

  std::vector<double> distances() && { return store_.release(); }

 private:
  PieceRunner& runner() const {
    static LocalPieces here;
    return question_.runner ? *question_.runner : here;
  }

  void run(const PieceQuestion& asked, const PieceRunner::Take& take) {
    runner().run(scan_, *meter_, question_.files, asked, question_.interrupted, take);
  }

  void add(const PieceFindings& found, std::size_t most) {
    store_.put(found.first, found.distances);
    const std::lock_guard lock(mutex_);
    kernel_seconds_ += found.seconds;
    farthest_.add(found.squared_bits, found.numbers());
    shown_.insert(found.farthest.begin(), found.farthest.end());
    while (shown_.size() > most) shown_.erase(std::prev(shown_.end()));
    ++pieces_done_;
    points_done_ += found.points;
    if (question_.advance && !meter_->parts()) {
      question_.advance(static_cast<double>(points_done_) / static_cast<double>(scan_.points()));
    }
  }

  const ScanPieces& scan_;
  const ErrorQuestion& question_;
  const std::optional<double> limit_;
  const std::size_t excludable_;
  const std::unique_ptr<PieceMeter> meter_;
  const MeshExtent extent_;
  const double margin_;

  std::mutex mutex_;  // of what follows
  FarthestPoints farthest_;
  std::set<FarthestPoint> shown_;
  double kernel_seconds_ = 0;  // the sum of all threads
  std::size_t pieces_done_ = 0;
  std::uint64_t points_done_ = 0;
  DistanceStore store_;  // has a lock of its own
};

SurfaceErrors measure_surface(const TriangleMesh& from, const TriangleMesh& to,
                              const ExactMesh& exact, double width,
                              const std::vector<double>& quantiles, std::optional<double> limit,
                              const std::function<bool()>& interrupted) {
  SurfaceDistanceOptions options;
  options.relative = kSurfacePrecision;
  options.absolute = kFinest * width;
  options.poll = [&] {
    if (interrupted && interrupted()) throw Interrupted{};
  };
  SurfaceDistance distance = surface_distance(from.view(), exact, options);
  if (limit && distance.lower <= *limit && !distance.within(*limit)) {
    options.limit = *limit;
    options.relative = kDecisionPrecision;
    options.absolute = 0;
    distance = surface_distance(from.view(), exact, options);
  }
  const PreparedCloud samples(surface_samples(from.view(), kSurfaceSamples));
  const auto distances = point_distances(samples, to.view(), interrupted, processor_threads());
  return {distance, statistics_of(distances, quantiles, limit)};
}

ReferenceErrors measure_reference(const TriangleMesh& mesh, const ExactMesh& exact_mesh,
                                  const ErrorReference& reference, double width,
                                  const std::vector<double>& quantiles, std::optional<double> limit,
                                  const std::function<bool()>& interrupted) {
  using Kind = ErrorReference::Kind;
  ReferenceErrors errors;
  errors.name = reference.name;
  errors.is_cloud = reference.kind != Kind::kSurface;
  errors.size = reference.mesh.triangles.size();
  if (reference.kind == Kind::kSurface) errors.topology = topology_of(reference.mesh.view());
  errors.from_mesh = measure_surface(mesh, reference.mesh, ExactMesh(reference.mesh.view()), width,
                                     quantiles, limit, interrupted);
  if (reference.kind != Kind::kScan) {
    errors.to_mesh =
        measure_surface(reference.mesh, mesh, exact_mesh, width, quantiles, limit, interrupted);
  }
  return errors;
}

struct MeshFindings {
  MeshValidity validity;
  MeshTopology topology;
};

MeshFindings check(const MeasuredMesh& mesh, const std::function<bool()>& interrupted) {
  if (mesh.is_whole()) {
    return {check_mesh(mesh.whole().view()), topology_of(mesh.whole().view())};
  }
  const PartwiseCheck found = mesh.check(processor_threads(), interrupted);
  return {found.validity, found.topology};
}

void measure_by_device(const TriangleMesh& mesh, const ScanPieces& scan,
                       const ErrorQuestion& question,
                       const std::function<void(ErrorConstraint&, const ErrorFindings&)>& measured,
                       ErrorFindings& f) {
  const auto start = std::chrono::steady_clock::now();
  ErrorConstraint constraint(scan.scan().cloud.points, f.errors.limit.value_or(0),
                             question.excluded_share, question.brute_force, processor_threads());
  f.measured =
      constraint.measure(mesh.view(), *question.device, {.interrupted = question.interrupted});
  f.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (measured) measured(constraint, f);
  f.measured.kept = in_file_indices(f.measured.kept, scan.scan().cloud);
  f.measured.all = in_file_indices(f.measured.all, scan.scan().cloud);
}

}  // namespace

ErrorReference cloud_reference(std::string name, ErrorReference::Kind kind,
                               std::vector<Point> points) {
  std::vector<Triangle> triangles = triangles_of_points(points.size());
  return {std::move(name), kind, {std::move(points), std::move(triangles)}};
}

std::string_view ErrorFindings::exceeding() const {
  const auto beyond = [this](const SurfaceErrors& surface) {
    return !surface.distance.within(*errors.limit);
  };
  const std::optional<ReferenceErrors>& reference = errors.reference;
  if (!certified.within(*errors.limit)) return "points are farther than that from the mesh";
  if (reference && beyond(reference->from_mesh)) {
    return "parts of the mesh are farther than that from the reference";
  }
  if (reference && reference->to_mesh && beyond(*reference->to_mesh)) {
    return "parts of the reference are farther than that from the mesh";
  }
  return "";
}

namespace {

// All but the faults and the topology of the mesh.
void measure(const MeasuredMesh& mesh, const ScanPieces& scan,
             const std::optional<ErrorReference>& reference, const ErrorQuestion& question,
             const std::function<void(ErrorConstraint&, const ErrorFindings&)>& measured,
             ErrorFindings& f) {
  const std::optional<double>& limit = f.errors.limit;
  CloudMeasurement cloud(scan, mesh, question, limit);
  cloud.measure();
  f.excludable = cloud.excludable();
  // Without a tolerance the farthest points are excluded, whatever their distance.
  f.measured = judge(cloud.extent(), f.transform, limit.value_or(0), cloud.farthest());
  f.seconds = cloud.kernel_seconds();
  f.certified = cloud.certify(f.measured.excluded);
  if (scan.is_in_memory()) {
    f.measured.excluded = in_cloud(f.measured.excluded, scan.scan().cloud);
  }
  if (question.device != nullptr) {
    const MeasuredError by_cpu = f.measured;
    measure_by_device(mesh.whole(), scan, question, measured, f);
    require_same(by_cpu, f.measured);
  }
  const PartwiseDistances* parts = cloud.meter().parts();
  f.triangles = parts != nullptr ? parts->triangles() : mesh.whole().triangles.size();
  const std::vector<double> quantiles =
      question.quantiles.empty()
          ? std::vector<double>(kUsualQuantiles.begin(), kUsualQuantiles.end())
          : question.quantiles;
  f.errors.cloud = cloud.errors(quantiles);
  if (reference) {
    f.errors.reference = measure_reference(mesh.whole(), cloud.meter().exact(), *reference,
                                           f.errors.width, quantiles, limit, question.interrupted);
  }
  f.distances = std::move(cloud).distances();
}

}  // namespace

ErrorFindings find_errors(
    const MeasuredMesh& mesh, const ScanPieces& scan,
    const std::optional<ErrorReference>& reference, const ErrorQuestion& question,
    const std::function<void(ErrorConstraint&, const ErrorFindings&)>& measured) {
  ErrorFindings f;
  f.tolerance = question.tolerance;
  f.errors.width = scan.scan().width;
  f.points = scan.points();
  f.transform = scan.normalization();
  if (f.tolerance) {
    f.errors.limit = f.tolerance->in_units(f.errors.width);
    require_resolution(scan.scan(), *f.errors.limit);
  }
  // The work that needs only the mesh runs beside the work that needs the cloud, or, for a mesh in
  // parts, once the memory of that is free.
  auto of_mesh = std::async(mesh.is_whole() ? std::launch::async : std::launch::deferred,
                            [&] { return check(mesh, question.interrupted); });
  measure(mesh, scan, reference, question, measured, f);
  const MeshFindings mesh_findings = of_mesh.get();
  f.validity = mesh_findings.validity;
  f.topology = mesh_findings.topology;
  return f;
}

ResultReport report_of(const ErrorFindings& f, const Scan& scan) {
  ResultReport report;
  if (f.tolerance) {
    report.feasible = f.feasible();
    report.epsilon = f.errors.limit;
  }
  report.validity = f.validity;
  report.topology = f.topology;
  report.triangles = f.triangles;
  report.certified = f.certified;
  report.kernel = f.measured.kept;
  report.points = f.points;
  if (scan.unit) report.unit = scan.unit->name;
  report.transform = f.transform;
  report.device = "cpu";
  report.errors = f.errors;
  return report;
}

}  // namespace emax
