#include "host/app/error_findings.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <numeric>
#include <utility>

#include "host/measure/point_distances.h"
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

// The kernel's distances. A distance that is printed, or that may lie on the other side of the
// limit, is replaced by the exact one.
class CloudMeasurement {
 public:
  CloudMeasurement(const Scan& scan, const ExactMesh& exact, std::vector<double> distances)
      : scan_(scan), exact_(exact), distances_(std::move(distances)) {}

  void settle(double limit, double margin) {
    for (std::size_t i = 0; i < distances_.size(); ++i) {
      if (std::abs(distances_[i] - limit) <= margin) {
        distances_[i] = exact_.distance(scan_.cloud.points[i]).upper;
      }
    }
  }

  CloudErrors errors(const std::vector<double>& quantiles, std::size_t worst,
                     std::optional<double> limit) {
    std::vector<std::uint32_t> order(distances_.size());
    std::iota(order.begin(), order.end(), 0u);
    // At least one, even if none is to be shown: it gives the maximum.
    const auto shown = order.begin() +
                       static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(worst, 1, order.size()));
    const auto farther = [this](std::uint32_t a, std::uint32_t b) {
      return distances_[a] != distances_[b] ? distances_[a] > distances_[b] : a < b;
    };
    std::ranges::partial_sort(order, shown, farther);
    std::vector<FarPoint> farthest;
    for (auto at = order.begin(); at != shown; ++at) {
      const ExactMesh::Nearest nearest = exact_.nearest(scan_.cloud.points[*at]);
      distances_[*at] = nearest.distance.upper;
      farthest.push_back({scan_.cloud.index_in_file(*at), scan_.cloud.points[*at],
                          nearest.distance.upper, nearest.triangle});
    }
    std::ranges::stable_sort(
        farthest, [](const FarPoint& a, const FarPoint& b) { return a.distance > b.distance; });
    farthest.resize(std::min(worst, farthest.size()));
    return {statistics_of(distances_, quantiles, limit), std::move(farthest)};
  }

  std::vector<double> distances() && { return std::move(distances_); }

 private:
  const Scan& scan_;
  const ExactMesh& exact_;
  std::vector<double> distances_;
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
  ExactMesh exact;
  MeshValidity validity;
  MeshTopology topology;
};

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

ErrorFindings find_errors(
    const TriangleMesh& mesh, const Scan& scan, const std::optional<ErrorReference>& reference,
    const ErrorQuestion& question,
    const std::function<void(ErrorConstraint&, const ErrorFindings&)>& measured) {
  ErrorFindings f;
  f.tolerance = question.tolerance;
  f.errors.width = scan.width;
  std::optional<double>& limit = f.errors.limit;
  if (f.tolerance) {
    limit = f.tolerance->in_units(scan.width);
    require_resolution(scan, *limit);
  }

  // The work that needs only the mesh runs beside the work that needs the cloud.
  auto of_mesh = std::async(std::launch::async, [&] {
    return MeshFindings{ExactMesh(mesh.view()), check_mesh(mesh.view()), topology_of(mesh.view())};
  });
  const auto start = std::chrono::steady_clock::now();
  // Without a tolerance the farthest points are excluded, whatever their distance.
  ErrorConstraint constraint(scan.cloud.points, limit.value_or(0), question.excluded_share,
                             question.brute_force, processor_threads());
  f.excludable = constraint.excludable();
  f.transform = constraint.cloud().normalization();
  std::optional<PreparedMesh> prepared;
  if (question.device != nullptr) {
    f.measured =
        constraint.measure(mesh.view(), *question.device, {.interrupted = question.interrupted});
  } else {
    prepared = constraint.prepare(mesh.view());
    f.measured = constraint.measure(mesh.view(), *prepared, question.interrupted);
  }
  f.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (measured) measured(constraint, f);
  const MeshFindings mesh_findings = of_mesh.get();
  f.validity = mesh_findings.validity;
  f.topology = mesh_findings.topology;
  f.certified = in_file_indices(
      certify(scan.cloud.points, mesh_findings.exact, f.measured.excluded, processor_threads()),
      scan.cloud);
  f.measured.kept.worst_point = scan.cloud.index_in_file(f.measured.kept.worst_point);

  const std::vector<double> quantiles =
      question.quantiles.empty()
          ? std::vector<double>(kUsualQuantiles.begin(), kUsualQuantiles.end())
          : question.quantiles;
  if (!prepared) prepared = constraint.prepare(mesh.view());
  CloudMeasurement cloud(scan, mesh_findings.exact,
                         constraint.distances(*prepared, question.interrupted));
  if (limit) cloud.settle(*limit, point_distance_margin(constraint.cloud(), mesh.view(), *limit));
  f.errors.cloud = cloud.errors(quantiles, question.worst, limit);
  f.distances = std::move(cloud).distances();
  if (reference) {
    f.errors.reference = measure_reference(mesh, mesh_findings.exact, *reference, scan.width,
                                           quantiles, limit, question.interrupted);
  }
  return f;
}

ResultReport report_of(const ErrorFindings& f, const TriangleMesh& mesh, const Scan& scan) {
  ResultReport report;
  if (f.tolerance) {
    report.feasible = f.feasible();
    report.epsilon = f.errors.limit;
  }
  report.validity = f.validity;
  report.topology = f.topology;
  report.triangles = mesh.triangles.size();
  report.certified = f.certified;
  report.kernel = f.measured.kept;
  report.points = scan.cloud.points.size();
  if (scan.unit) report.unit = scan.unit->name;
  report.transform = f.transform;
  report.device = "cpu";
  report.errors = f.errors;
  return report;
}

}  // namespace emax
