#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <numeric>

#include "host/app/commands.h"
#include "host/app/device_report.h"
#include "host/app/error_findings.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/phase_progress.h"
#include "host/app/reference_text.h"
#include "host/app/report_output.h"
#include "host/files/atomic_file.h"
#include "host/files/cloud_file.h"
#include "host/files/las_stream.h"
#include "host/files/mesh_file.h"
#include "host/files/pipe_input.h"
#include "host/files/sha256.h"
#include "host/files/spooled_input.h"
#include "host/files/tolerance.h"
#include "host/geometry/merge_vertices.h"
#include "host/measure/error_constraint.h"
#include "host/measure/point_distances.h"
#include "host/report/deviations.h"
#include "host/report/error_ply.h"
#include "host/report/result_json.h"
#include "host/report/surface_samples.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::array<std::string_view, 1> kColorEndings = {".ply"};
constexpr std::array<std::string_view, 2> kDeviationEndings = {".ply", ".glb"};

void check_outputs(const ErrorOptions& options) {
  const std::string& json = options.common.json;
  if (!json.empty()) check_output(json, kJsonEndings);
  if (!options.color.empty()) check_output(options.color, kColorEndings);
  if (!options.color_mesh.empty()) check_output(options.color_mesh, kColorEndings);
  if (!options.deviations.empty()) check_output(options.deviations, kDeviationEndings);
  const ReportOptions& report = options.common.report;
  check_report_outputs(report);
  check_distinct(
      {json, options.color, options.color_mesh, options.deviations, report.report, report.picture},
      {options.common.cloud, options.mesh, options.reference});
}

// Throws Error if an option needs the whole mesh and it is read in parts.
void require_whole(const ErrorOptions& options, const MeasuredMesh& mesh) {
  if (options.common.device != "cpu") mesh.require_whole("--device");
  if (options.two_sided) mesh.require_whole("--two-sided");
  if (!options.deviations.empty()) mesh.require_whole("--deviations");
  if (!options.common.report.report.empty()) mesh.require_whole("--report");
  if (!options.common.report.picture.empty()) mesh.require_whole("--picture");
}

// Throws Error if an option needs all points at a time and they are not in memory.
void require_room(const ErrorOptions& options, const MeasuredMesh& mesh, const ScanPieces& scan) {
  if (!mesh.is_whole()) scan.require_more_than_once("a mesh in parts");
  if (options.common.device != "cpu") scan.require_in_memory("--device");
  if (options.two_sided && options.reference.empty()) {
    scan.require_in_memory("--two-sided without --reference");
  }
  if (!options.color.empty()) scan.require_in_memory("--color");
  if (!options.deviations.empty()) scan.require_in_memory("--deviations");
  scan.require_in_memory(options.common.report);
  if (parse_share(options.common.excluded_share) > 0) {
    scan.require_more_than_once("--exclude-outliers");
  }
  if (!options.common.reading.left_out_classes.empty()) scan.require_more_than_once("--class");
}

// Whether one look at the points of a cloud that does not fit into memory is enough.
bool is_one_look(const ErrorOptions& options, const MeasuredMesh& mesh) {
  const bool is_two_sided_alone = options.two_sided && options.reference.empty();
  return mesh.is_whole() && options.common.device == "cpu" && !is_two_sided_alone &&
         options.color.empty() && options.deviations.empty() && !options.common.report.any() &&
         parse_share(options.common.excluded_share) == 0 &&
         options.common.reading.left_out_classes.empty() && options.reference != kStandardInput;
}

// The cloud, where it comes through a pipe and is measured as it comes. Standard input is copied
// into a file where that is not enough.
std::unique_ptr<LasStream> stream_of(const ErrorOptions& options, const MeasuredMesh& mesh) {
  const std::string& cloud = options.common.cloud;
  if (!is_pipe(cloud)) return nullptr;
  const bool is_copied =
      cloud == kStandardInput &&
      (!is_one_look(options, mesh) || format_of_content(standard_input_head()) != ".las");
  if (is_copied) return nullptr;
  if (!options.common.report.report.empty()) {
    throw Error(fmt::format("{}: is a pipe, and --report states the checksum of a file; {}", cloud,
                            kStoreFirst));
  }
  return std::make_unique<LasStream>(cloud);
}

ErrorReference read_reference(const ErrorOptions& options, const Scan& scan) {
  if (options.reference.empty()) {
    return cloud_reference(scan.path.string(), ErrorReference::Kind::kScan, scan.cloud.points);
  }
  if (is_surface(options.reference)) {
    MeshFile file = read_mesh_file(options.reference);
    require_unit_of(scan, options.reference, file.unit);
    return {options.reference, ErrorReference::Kind::kSurface, std::move(file.mesh)};
  }
  PointCloud cloud = read_cloud(options.reference, {options.common.reading.skip_invalid});
  return cloud_reference(options.reference, ErrorReference::Kind::kCloud, std::move(cloud.points));
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

void write_deviations(Facts& facts, const std::string& path, const TriangleMesh& mesh,
                      const Scan& scan, const ErrorFindings& f) {
  const Deviations found =
      deviations_of(scan.cloud.points, mesh.view(), f.measured.excluded, processor_threads());
  const std::vector<float> of_vertices = deviations_of_vertices(mesh.view(), found.of_triangles);
  write_mesh(
      path, mesh,
      {.unit = scan.unit, .deviation = of_vertices, .deviation_of_triangles = found.of_triangles});
  facts.add("deviations", "{}: of each vertex{}{}", path,
            lower_case_ending(path) == ".ply" ? " and triangle" : "",
            found.are_signed ? ", + outside" : "");
}

// What a device adds to the findings.
struct DeviceFindings {
  std::optional<DeviceCounters> counters;
  std::optional<BoardModel> board;
  std::optional<double> cpu_seconds;
};

void print_mesh(Facts& facts, const ErrorFindings& f, const ErrorOptions& options,
                const MeasuredMesh& mesh) {
  facts.add("mesh", "{}: {} triangles{}; {}", options.mesh, grouped(f.triangles),
            mesh.is_whole() ? "" : ", in parts", describe(f.validity));
  facts.add("topology", "{}", describe(f.topology, f.reference_topology()));
  if (!mesh.remark().empty()) facts.add("remark", "{}", mesh.remark());
}

void print(Facts& facts, const ErrorFindings& f, const DeviceFindings& d,
           const ErrorOptions& options, const Scan& scan, const MeasuredMesh& mesh) {
  facts.add("cloud", "{}", describe(scan, f.points));
  print_left_out(facts, scan.cloud);
  print_doubtful_unit(facts, scan.width, scan.unit);
  print_mesh(facts, f, options, mesh);
  facts.add("e_max", "{:.9g} certified ({:.4g}% of the width)", f.certified.e_max_upper,
            100 * f.certified.e_max_upper / scan.width);
  print_excluded(facts, f.certified, f.excludable);
  if (f.tolerance) {
    facts.add("tolerance", "{}{}: {}", to_text(*f.tolerance, scan.width, scan.unit),
              level_text(options.level),
              f.feasible() ? "kept" : fmt::format("exceeded: {}", f.exceeding()));
  }
  facts.add("worst point", "{}", f.measured.kept.worst_point);
  facts.add("kernel", "e_max^2 bits 0x{:08x}", f.measured.kept.squared_bits);
  facts.add_passing("device " + options.common.device, "{} in {:.3f} s",
                    describe_counters(d.counters), f.seconds);
  if (d.board) print_prediction(facts, *d.board, *d.counters, *d.cpu_seconds);
  fmt::print("{}", to_text(f.errors));
}

std::string json_text(const ErrorFindings& f, const DeviceFindings& d, const ErrorOptions& options,
                      const Scan& scan) {
  ResultReport report = report_of(f, scan);
  report.device = options.common.device;
  report.counters = d.counters;
  report.board = d.board;
  report.cpu_seconds = d.cpu_seconds;
  report.page = options.common.report.report;
  report.picture = options.common.report.picture;
  return to_json_text(report);
}

std::string verdict_of(const ErrorFindings& f, const Scan& scan) {
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
    if (!file.empty()) inputs.push_back(report_input(name, file, sha256_of_input(file)));
  };
  add("cloud", options.common.cloud);
  add("mesh", options.mesh);
  add("reference", options.reference);
  return inputs;
}

void write_report_of(Facts& facts, const ErrorFindings& f, const ErrorOptions& options,
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
  ErrorQuestion question;
  question.excluded_share = parse_share(options.common.excluded_share);
  question.tolerance = given_tolerance(options.max_error, options.level);
  check_outputs(options);
  question.memory = options.memory.value_or(question.memory);
  question.files = {options.mesh, {}, true};
  MeasuredMesh mesh(options.mesh, question.memory);
  mesh.drop_unused_vertices();  // vertices without a triangle get no colour
  require_whole(options, mesh);
  LocalPieces here;  // measures a mesh in parts
  question.runner = mesh.is_whole() ? options.machines.pieces.get() : &here;
  PhaseProgress phase;
  phase.begin("reading the cloud", reading_seconds(options.common.cloud));
  const ScanPieces pieces(options.common.cloud, options.common.reading, options.common.unit,
                          mesh.memory_for_points(), was_interrupted, stream_of(options, mesh),
                          question.runner->threads(options.common.cloud, question.files));
  phase.end();
  const Scan& scan = pieces.scan();
  require_room(options, mesh, pieces);
  require_unit_of(scan, options.mesh, mesh.file().unit);
  if (question.tolerance) question.tolerance = question.tolerance->in_unit_of(scan.unit);
  std::optional<ErrorReference> reference;
  if (options.two_sided) reference = read_reference(options, scan);
  std::vector<ReportInput> inputs = inputs_of(options);
  const auto device = make_evaluator(address);
  question.quantiles = options.quantiles;
  question.worst = options.worst;
  question.brute_force = options.common.brute_force;
  question.device = device.get();
  question.interrupted = was_interrupted;
  question.advance = [&phase](double share) { phase.advance(share); };
  DeviceFindings d;
  phase.begin("measuring");
  const ErrorFindings f = find_errors(mesh, pieces, reference, question,
                                      [&](ErrorConstraint& constraint, const ErrorFindings& now) {
                                        if (device) d.counters = device->counters();
                                        d.board = address.board;
                                        if (!d.board) return;
                                        CpuTwin cpu(constraint);
                                        cpu.measure(mesh.whole().view(), now.measured);
                                        d.cpu_seconds = cpu.seconds();
                                      });
  phase.end();
  const std::optional<double>& limit = f.errors.limit;

  const std::string& json = options.common.json;
  Facts facts;
  print(facts, f, d, options, scan, mesh);
  if (!options.color.empty()) {
    write_colors(facts, options.color, scan.cloud.points, f.distances, {}, limit);
  }
  const TriangleMesh& whole = mesh.whole();  // where an output needs it
  if (!options.color_mesh.empty()) {
    const auto distances =
        point_distances(PreparedCloud(whole.vertices), reference->mesh.view(), was_interrupted);
    write_colors(facts, options.color_mesh, whole.vertices, distances, whole.triangles, limit);
  }
  if (!options.deviations.empty()) write_deviations(facts, options.deviations, whole, scan, f);
  write_report_of(facts, f, options, whole, scan, std::move(inputs));
  if (json_is_wanted(json)) {
    write_json(json, json_text(f, d, options, scan));
  }
  return question.tolerance && !f.feasible() ? kExitNo : kExitOk;
}

}  // namespace emax
