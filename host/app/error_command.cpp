#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <future>
#include <numeric>

#include "host/app/commands.h"
#include "host/app/device_report.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/reference_text.h"
#include "host/app/report_output.h"
#include "host/files/atomic_file.h"
#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/files/tolerance.h"
#include "host/geometry/merge_vertices.h"
#include "host/measure/error_constraint.h"
#include "host/measure/point_distances.h"
#include "host/report/error_ply.h"
#include "host/report/result_json.h"
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
constexpr std::array<std::string_view, 1> kColorEndings = {".ply"};

void check_outputs(const ErrorOptions& options) {
  const std::string& json = options.common.json;
  if (!json.empty()) check_output(json, kJsonEndings);
  if (!options.color.empty()) check_output(options.color, kColorEndings);
  if (!options.color_mesh.empty()) check_output(options.color_mesh, kColorEndings);
  const ReportOptions& report = options.common.report;
  check_report_outputs(report);
  check_distinct({json, options.color, options.color_mesh, report.report, report.picture},
                 {options.common.cloud, options.mesh, options.reference});
}

// The reference that the mesh is measured against: a surface, or a cloud as triangles of no size.
struct Reference {
  std::string name;
  // kScan: the cloud that is measured; kCloud: another cloud.
  enum class Kind { kScan, kCloud, kSurface } kind;
  TriangleMesh mesh;
};

Reference cloud_reference(std::string name, Reference::Kind kind, std::vector<Point> points) {
  std::vector<Triangle> triangles = triangles_of_points(points.size());
  return {std::move(name), kind, {std::move(points), std::move(triangles)}};
}

Reference read_reference(const ErrorOptions& options, const Scan& scan) {
  if (options.reference.empty()) {
    return cloud_reference(scan.path.string(), Reference::Kind::kScan, scan.cloud.points);
  }
  if (is_surface(options.reference)) {
    return {options.reference, Reference::Kind::kSurface, read_mesh(options.reference)};
  }
  PointCloud cloud = read_cloud(options.reference, {options.common.reading.skip_invalid});
  return cloud_reference(options.reference, Reference::Kind::kCloud, std::move(cloud.points));
}

void throw_if_interrupted() {
  if (was_interrupted()) throw Interrupted{};
}

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

  std::span<const double> distances() const { return distances_; }

 private:
  const Scan& scan_;
  const ExactMesh& exact_;
  std::vector<double> distances_;
};

SurfaceErrors measure_surface(const TriangleMesh& from, const TriangleMesh& to,
                              const ExactMesh& exact, double width,
                              const std::vector<double>& quantiles, std::optional<double> limit) {
  SurfaceDistanceOptions options;
  options.relative = kSurfacePrecision;
  options.absolute = kFinest * width;
  options.poll = throw_if_interrupted;
  SurfaceDistance distance = surface_distance(from.view(), exact, options);
  if (limit && distance.lower <= *limit && !distance.within(*limit)) {
    options.limit = *limit;
    options.relative = kDecisionPrecision;
    options.absolute = 0;
    distance = surface_distance(from.view(), exact, options);
  }
  const PreparedCloud samples(surface_samples(from.view(), kSurfaceSamples));
  const auto distances = point_distances(samples, to.view(), was_interrupted, processor_threads());
  return {distance, statistics_of(distances, quantiles, limit)};
}

ReferenceErrors measure_reference(const TriangleMesh& mesh, const ExactMesh& exact_mesh,
                                  const Reference& reference, double width,
                                  const std::vector<double>& quantiles,
                                  std::optional<double> limit) {
  using Kind = Reference::Kind;
  ReferenceErrors errors;
  errors.name = reference.name;
  errors.is_cloud = reference.kind != Kind::kSurface;
  errors.size = reference.mesh.triangles.size();
  if (reference.kind == Kind::kSurface) errors.topology = topology_of(reference.mesh.view());
  errors.from_mesh = measure_surface(mesh, reference.mesh, ExactMesh(reference.mesh.view()), width,
                                     quantiles, limit);
  if (reference.kind != Kind::kScan) {
    errors.to_mesh = measure_surface(reference.mesh, mesh, exact_mesh, width, quantiles, limit);
  }
  return errors;
}

// The distance that gets the last colour: the tolerance, or the greatest distance without one.
double color_range(std::span<const double> distances, std::optional<double> limit) {
  return limit ? *limit : *std::ranges::max_element(distances);
}

void write_colors(Facts& facts, const std::string& path, std::span<const Point> points,
                  std::span<const double> distances, std::span<const Triangle> triangles,
                  std::optional<double> limit) {
  const double greatest = color_range(distances, limit);
  write_error_ply(path, points, distances, greatest, triangles);
  facts.add("colours", "{}: viridis, dark blue 0, green {:.6g}, yellow {:.6g}{}", path,
            greatest / 2, greatest, limit ? " and beyond" : "");
}

struct MeshFindings {
  ExactMesh exact;
  MeshValidity validity;
  MeshTopology topology;
};

// All results for the mesh.
struct Findings {
  std::optional<Tolerance> tolerance;
  MeasuredError measured = {};
  double seconds = 0;
  std::optional<DeviceCounters> counters;
  std::optional<BoardModel> board;
  std::optional<double> cpu_seconds;
  CertifiedError certified;
  MeshValidity validity;
  MeshTopology topology;
  ErrorReport errors;

  std::optional<MeshTopology> reference_topology() const {
    return errors.reference ? errors.reference->topology : std::nullopt;
  }
  // Names the parts that are farther than the tolerance; empty if it is kept.
  std::string_view exceeding() const {
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
  bool feasible() const { return errors.limit && exceeding().empty(); }
};

void print(Facts& facts, const Findings& f, const ErrorOptions& options, const Scan& scan,
           const TriangleMesh& mesh, std::size_t excludable) {
  facts.add("cloud", "{}", describe(scan));
  print_left_out(facts, scan.cloud);
  facts.add("mesh", "{}: {} triangles; {}", options.mesh, grouped(mesh.triangles.size()),
            describe(f.validity));
  facts.add("topology", "{}", describe(f.topology, f.reference_topology()));
  facts.add("e_max", "{:.9g} certified ({:.4g}% of the width)", f.certified.e_max_upper,
            100 * f.certified.e_max_upper / scan.width);
  print_excluded(facts, f.certified, excludable);
  if (f.tolerance) {
    facts.add("tolerance", "{}{}: {}", to_text(*f.tolerance, scan.width, scan.unit),
              level_text(options.level),
              f.feasible() ? "kept" : fmt::format("exceeded: {}", f.exceeding()));
  }
  facts.add("worst point", "{}", f.measured.kept.worst_point);
  facts.add("kernel", "e_max^2 bits 0x{:08x}", f.measured.kept.squared_bits);
  facts.add_passing("device " + options.common.device, "{} in {:.3f} s",
                    describe_counters(f.counters), f.seconds);
  if (f.board) print_prediction(facts, *f.board, *f.counters, *f.cpu_seconds);
  fmt::print("{}", to_text(f.errors));
}

std::string json_text(const Findings& f, const ErrorOptions& options, const TriangleMesh& mesh,
                      const Scan& scan, const Normalization& transform) {
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
  report.transform = transform;
  report.device = options.common.device;
  report.counters = f.counters;
  report.board = f.board;
  report.cpu_seconds = f.cpu_seconds;
  report.errors = f.errors;
  report.page = options.common.report.report;
  report.picture = options.common.report.picture;
  return to_json_text(report);
}

std::string verdict_of(const Findings& f, const Scan& scan) {
  const auto length = [&](double value) { return length_text(value, scan.unit); };
  if (!f.errors.limit) {
    return fmt::format("The farthest point lies {} from the mesh.",
                       length(f.certified.e_max_upper));
  }
  if (f.feasible()) {
    return fmt::format("Within tolerance: every {}point lies within {} of the mesh.",
                       f.certified.excluded.empty() ? "" : "kept ", length(*f.errors.limit));
  }
  return fmt::format("Not within {}: {}.", length(*f.errors.limit), f.exceeding());
}

// The files of a report, with the checksums that they had when they were read.
std::vector<ReportInput> inputs_of(const ErrorOptions& options) {
  std::vector<ReportInput> inputs;
  if (options.common.report.report.empty()) return inputs;
  const auto add = [&](const char* name, const std::string& file) {
    if (!file.empty()) inputs.push_back(report_input(name, file, sha256_of_file(file)));
  };
  add("cloud", options.common.cloud);
  add("mesh", options.mesh);
  add("reference", options.reference);
  return inputs;
}

void write_report_of(Facts& facts, const Findings& f, const ErrorOptions& options,
                     const TriangleMesh& mesh, const Scan& scan, std::vector<ReportInput> inputs) {
  const ReportOptions& wanted = options.common.report;
  if (!wanted.any()) return;
  ReportData report =
      measured_report(wanted, scan, mesh.view(), f.measured.excluded, f.errors.limit);
  report.command = "error";
  report.title = std::filesystem::path(options.mesh).filename().string();
  if (f.tolerance) report.within = f.feasible();
  report.verdict = verdict_of(f, scan);
  report.e_max = f.certified.e_max_upper;
  if (f.errors.reference) report.back = f.errors.reference->from_mesh.distance.upper;
  report.provenance = std::move(inputs);
  report.times.push_back({"e_max on " + options.common.device, f.seconds});
  write_report(wanted, std::move(report), facts);
}

}  // namespace

int run_error(const ErrorOptions& options) {
  const DeviceAddress address = DeviceAddress::parse(options.common.device);
  const double share = parse_share(options.common.excluded_share);
  Findings f;
  f.tolerance = given_tolerance(options.max_error, options.level);
  check_outputs(options);
  TriangleMesh mesh = read_mesh(options.mesh);
  drop_unused_vertices(mesh.vertices, mesh.triangles);  // vertices without a triangle get no colour
  const Scan scan = read_scan(options.common.cloud, options.common.reading, options.common.unit);
  if (f.tolerance) f.tolerance = f.tolerance->in_unit_of(scan.unit);
  std::optional<Reference> reference;
  if (options.two_sided) reference = read_reference(options, scan);
  std::vector<ReportInput> inputs = inputs_of(options);
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
  ErrorConstraint constraint(scan.cloud.points, limit.value_or(0), share,
                             options.common.brute_force, processor_threads());
  const auto device = make_evaluator(address);
  std::optional<PreparedMesh> prepared;
  if (device) {
    f.measured = constraint.measure(mesh.view(), *device, {.interrupted = was_interrupted});
  } else {
    prepared = constraint.prepare(mesh.view());
    f.measured = constraint.measure(mesh.view(), *prepared, was_interrupted);
  }
  f.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (device) f.counters = device->counters();
  f.board = address.board;
  if (f.board) {
    CpuTwin cpu(constraint);
    cpu.measure(mesh.view(), f.measured);
    f.cpu_seconds = cpu.seconds();
  }
  const MeshFindings mesh_findings = of_mesh.get();
  f.validity = mesh_findings.validity;
  f.topology = mesh_findings.topology;
  f.certified = in_file_indices(
      certify(scan.cloud.points, mesh_findings.exact, f.measured.excluded, processor_threads()),
      scan.cloud);
  f.measured.kept.worst_point = scan.cloud.index_in_file(f.measured.kept.worst_point);

  const std::vector<double> quantiles =
      options.quantiles.empty()
          ? std::vector<double>(kUsualQuantiles.begin(), kUsualQuantiles.end())
          : options.quantiles;
  if (!prepared) prepared = constraint.prepare(mesh.view());
  CloudMeasurement cloud(scan, mesh_findings.exact,
                         constraint.distances(*prepared, was_interrupted));
  if (limit) cloud.settle(*limit, point_distance_margin(constraint.cloud(), mesh.view(), *limit));
  f.errors.cloud = cloud.errors(quantiles, options.worst, limit);
  if (reference) {
    f.errors.reference =
        measure_reference(mesh, mesh_findings.exact, *reference, scan.width, quantiles, limit);
  }

  const std::string& json = options.common.json;
  Facts facts;
  print(facts, f, options, scan, mesh, constraint.excludable());
  if (!options.color.empty()) {
    write_colors(facts, options.color, scan.cloud.points, cloud.distances(), {}, limit);
  }
  if (!options.color_mesh.empty()) {
    const auto distances =
        point_distances(PreparedCloud(mesh.vertices), reference->mesh.view(), was_interrupted);
    write_colors(facts, options.color_mesh, mesh.vertices, distances, mesh.triangles, limit);
  }
  write_report_of(facts, f, options, mesh, scan, std::move(inputs));
  if (json_is_wanted(json)) {
    write_json(json, json_text(f, options, mesh, scan, constraint.cloud().normalization()));
  }
  return f.tolerance && !f.feasible() ? kExitNo : kExitOk;
}

}  // namespace emax
