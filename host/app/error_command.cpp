#include <fmt/format.h>

#include <chrono>

#include "host/app/commands.h"
#include "host/app/device_report.h"
#include "host/app/interrupt.h"
#include "host/geometry/atomic_file.h"
#include "host/geometry/mesh_file.h"
#include "host/geometry/tolerance.h"
#include "host/optimize/error_constraint.h"
#include "host/report/result_json.h"

namespace emax {

int run_error(const ErrorOptions& options) {
  const DeviceAddress address = DeviceAddress::parse(options.common.device);
  const double share = parse_share(options.common.excluded_share);
  std::optional<Tolerance> tolerance;
  if (!options.max_error.empty()) tolerance = parse_tolerance(options.max_error);
  if (!options.common.json.empty()) check_output(options.common.json, kJsonEndings);
  const TriangleMesh mesh = read_mesh(options.mesh);
  const Scan scan = read_scan(options.common.cloud, options.common.skip_invalid);
  // Without a tolerance the farthest points are excluded whatever their distance.
  const double epsilon = tolerance ? tolerance->in_units(scan.width) : 0;

  const auto start = std::chrono::steady_clock::now();
  const ErrorConstraint constraint(scan.cloud.points, epsilon, share, options.common.brute_force);
  const auto evaluator = make_evaluator(address);
  SearchOptions search;
  search.interrupted = was_interrupted;
  MeasuredError measured = constraint.measure(mesh.view(), *evaluator, search);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const DeviceCounters counters = evaluator->counters();
  std::optional<CpuTwin> cpu;
  if (address.board) cpu.emplace(constraint).measure(mesh.view(), measured);
  const CertifiedError certified =
      in_file_indices(certify(scan.cloud.points, mesh.view(), measured.excluded), scan.cloud);
  measured.kept.worst_point = scan.cloud.index_in_file(measured.kept.worst_point);
  const MeshValidity validity = check_mesh(mesh.view());
  const bool feasible = tolerance && certified.within(epsilon);

  fmt::print("cloud          {}: {} points, width {:.6g}\n", scan.path.string(),
             grouped(scan.cloud.points.size()), scan.width);
  fmt::print("mesh           {}: {} triangles; {}\n", options.mesh, grouped(mesh.triangles.size()),
             describe(validity));
  fmt::print("e_max          {:.9g} certified ({:.4g}% of the width)\n", certified.e_max_upper,
             100 * certified.e_max_upper / scan.width);
  print_excluded(certified, constraint.excludable());
  if (tolerance) {
    fmt::print("tolerance      {}: {}\n", to_text(*tolerance, scan.width),
               feasible ? "kept" : "exceeded");
  }
  fmt::print("worst point    {}\n", measured.kept.worst_point);
  fmt::print("kernel         e_max^2 bits 0x{:08x}\n", measured.kept.squared_bits);
  fmt::print("device {:<7} {} in {:.3f} s\n", options.common.device, describe_counters(counters),
             took.count());
  if (address.board) print_prediction(*address.board, counters, cpu->seconds());

  if (!options.common.json.empty()) {
    ResultReport report;
    if (tolerance) {
      report.feasible = feasible;
      report.epsilon = epsilon;
    }
    report.validity = validity;
    report.triangles = mesh.triangles.size();
    report.certified = certified;
    report.kernel = measured.kept;
    report.points = scan.cloud.points.size();
    report.transform = constraint.cloud().normalization();
    report.seed = options.common.seed;
    report.device = options.common.device;
    report.counters = counters;
    report.board = address.board;
    if (cpu) report.cpu_seconds = cpu->seconds();
    write_atomically(options.common.json, to_json_text(report));
  }
  return tolerance && !feasible ? kExitNo : kExitOk;
}

}  // namespace emax
