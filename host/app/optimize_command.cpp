#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "host/app/commands.h"
#include "host/app/device_report.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/progress.h"
#include "host/app/reference_text.h"
#include "host/app/run_identity.h"
#include "host/geometry/atomic_file.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/sha256.h"
#include "host/geometry/tolerance.h"
#include "host/optimize/optimize.h"
#include "host/optimize/run_bound.h"
#include "host/report/certificate_file.h"
#include "host/report/result_json.h"
#include "sw_model/error.h"
#include "sw_model/parallel.h"
#include "sw_model/surface_distance.h"

namespace emax {
namespace {

std::string describe_failures(const OptimizeState& state) {
  std::string text;
  for (const auto& [reason, count] : state.failures) {
    text += fmt::format(", {} failed ({})", count, reason);
  }
  if (!state.last_failure.empty()) text += fmt::format("; last: {}", state.last_failure);
  return text;
}

OptimizeSettings make_settings(const OptimizeOptions& options) {
  OptimizeSettings settings;
  settings.method = method_for(options.method, options.decimator);
  settings.decimator = options.decimator;
  const auto parameters = chain_parameters(settings.method, options.decimator);
  settings.config =
      options.config.empty() ? default_config(parameters) : read_config(options.config, parameters);
  if (options.budget) settings.config.search.budget = *options.budget;
  settings.seed = options.seed;
  if (options.seconds) settings.time = std::chrono::duration<double>(*options.seconds);
  const unsigned jobs =
      options.jobs > 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
  // No more candidates than that are ever out.
  settings.jobs =
      static_cast<unsigned>(std::min<std::size_t>(jobs, settings.config.search.look_ahead));
  settings.target_triangles = options.target_triangles;
  settings.stagnation = options.stagnation;
  settings.polish = options.polish;
  settings.output = options.output;
  settings.interrupted = was_interrupted;
  return settings;
}

EvaluationLimits evaluation_limits(const OptimizeOptions& options, std::size_t points) {
  EvaluationLimits limits = standard_limits(points);
  if (options.evaluation_seconds) {
    limits.time = std::chrono::ceil<std::chrono::milliseconds>(
        std::chrono::duration<double>(*options.evaluation_seconds));
  }
  if (options.evaluation_memory) limits.memory = *options.evaluation_memory;
  return limits;
}

// What the scan is like and what surface was made of it; nothing where none was.
void print_fit(const ReferenceFit& fit, double epsilon) {
  if (fit.tried.empty()) return;
  fmt::print(
      "scan           points {:.3g} apart ({:.3g} of the tolerance), noise {:.2g} ({:.2g})\n",
      fit.scan.spacing, fit.scan.spacing / epsilon, fit.scan.noise, fit.scan.noise / epsilon);
  for (const TriedSurface& tried : fit.tried) {
    const bool taken = &tried == &fit.best();
    fmt::print("{:<14} {}: {}\n", taken ? "surface" : "not taken", tried.chain.method,
               tried.failure.empty() ? describe(tried) : tried.failure);
  }
  if (fit.surface.dropped_triangles + fit.surface.dropped_pieces + fit.surface.closed_cracks > 0) {
    fmt::print(
        "mended         {} cracks closed, {} needless pieces of {:.3g} area and {} triangles "
        "dropped\n",
        grouped(fit.surface.closed_cracks), grouped(fit.surface.dropped_pieces),
        fit.surface.dropped_area, grouped(fit.surface.dropped_triangles));
  }
  if (fit.joined + fit.left_out > 0) {
    fmt::print("far points     {} farther than {:.3g} joined to it, {} left out\n",
               grouped(fit.joined), fit.joined_beyond, grouped(fit.left_out));
  }
}

std::string_view ended_by(const OptimizeState& state) {
  if (state.interrupted) return "interrupt";
  if (!state.device_failure.empty()) return "device";
  if (state.out_of_time) return "time";
  if (state.target_reached) return "target";
  return state.stagnated ? "stagnation" : "budget";
}

EmaxResult in_file_indices(EmaxResult result, const PointCloud& cloud) {
  result.worst_point = cloud.index_in_file(result.worst_point);
  return result;
}

class OptimizeCommand {
 public:
  explicit OptimizeCommand(const OptimizeOptions& options)
      : options_(options),
        settings_(make_settings(options)),
        address_(DeviceAddress::parse(options.common.device)),
        device_(make_evaluator(address_)) {
    const double share = parse_share(options.common.excluded_share);
    const Tolerance tolerance = parse_tolerance(options.max_error);
    const bool bounded = options.decimator == "bounded";
    const bool two_sided = options.bound.empty() ? bounded : options.bound == "two-sided";
    if (two_sided && !bounded) {
      throw Error(
          "--bound two-sided needs --decimator bounded; the paper's chain bounds the points");
    }
    check_mesh_outputs(options.output, two_sided);
    if (!options.common.json.empty()) check_output(options.common.json, kJsonEndings);
    check_distinct({options.output, certificate_path(options.output),
                    two_sided ? reference_path(options.output) : "", options.common.json},
                   {options.common.cloud, options.config});
    const std::string folder = options.resume.empty() ? options.output + ".run" : options.resume;
    check_outside({options.output, certificate_path(options.output), options.common.json}, folder);
    scan_ = read_scan(options.common.cloud, options.common.skip_invalid);
    cloud_sha256_ = sha256_of_file(scan_.path);
    epsilon_ = below_width(tolerance, "--max-error", scan_);
    if (two_sided) settings_.epsilon_back = epsilon_;
    constraint_.emplace(scan_.cloud.points, epsilon_, share, options.common.brute_force);
    settings_.limits = evaluation_limits(options, scan_.cloud.points.size());
    if (options.jobs == 0) {
      settings_.jobs = std::min(settings_.jobs, jobs_in_memory(*settings_.limits));
    }
    log_.emplace(folder, run_settings(options, settings_, cloud_sha256_, epsilon_));
    settings_.log = &*log_;
    fmt::print("run            {}\n", describe(*log_, settings_.config.search.budget));
    fmt::print("cloud          {}: {} points, width {:.6g}\n", scan_.path.string(),
               grouped(scan_.cloud.points.size()), scan_.width);
    fmt::print("tolerance      {}, {}\n", to_text(tolerance, scan_.width),
               two_sided ? "two-sided" : "one-sided");
    fmt::print("search         {} + {}, {} evaluations, seed {}, {} jobs, device {}\n",
               settings_.method, settings_.decimator, settings_.config.search.budget,
               settings_.seed, settings_.jobs, options.common.device);
    std::fflush(stdout);
  }

  int run() {
    try {
      fix_bound();
      return search();
    } catch (const Interrupted&) {
      if (!said_what_is_kept_ && log_->size() > 0)
        say_what_is_kept("; the same command continues it");
      throw;
    } catch (const Error& error) {
      if (said_what_is_kept_ || log_->size() == 0) throw;
      throw Error(fmt::format("{}; the evaluations are kept: the same command continues in {}",
                              error.what(), log_->folder().string()));
    }
  }

 private:
  int search() {
    const auto start = std::chrono::steady_clock::now();
    if (address_.board) {
      cpu_.emplace(*constraint_);
      settings_.measured = [this](MeshView mesh, const MeasuredError& error) {
        cpu_->measure(mesh, error);
      };
    }
    {
      Progress progress(*constraint_, settings_.time);
      state_ = optimize(scan_.cloud.points, *constraint_, device_.get(), settings_,
                        [&progress](const OptimizeState& state) { progress.show(state); });
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (device_) counters_ = device_->counters();
    if (!state_.best && !state_.least_error) {
      end_run();
      if (state_.interrupted) throw Interrupted{};
      if (!state_.device_failure.empty()) throw DeviceFailure(state_.device_failure);
      if (state_.out_of_time && state_.evaluations == 0) {
        throw Error("--time ended before the first evaluation; allow for more");
      }
      throw Error(fmt::format("{}: no mesh could be made of it in {} evaluations{}",
                              scan_.path.string(), state_.evaluations, describe_failures(state_)));
    }
    const BestMesh& shown = state_.best ? *state_.best : *state_.least_error;
    validity_ = check_mesh(shown.mesh.view());
    topology_ = topology_of(shown.mesh.view());
    certified_ =
        certify(scan_.cloud.points, shown.mesh.view(), shown.error.excluded, processor_threads());
    if (state_.best) {
      keep(*state_.best);
    } else {
      refuse(*state_.least_error);
    }
    print_common(shown, took.count());
    write_json(shown);
    end_run();
    if (state_.interrupted) return kExitInterrupted;
    if (!state_.device_failure.empty()) {
      throw DeviceFailure(state_.device_failure +
                          "; the search ended there, with the result above");
    }
    return state_.best ? kExitOk : kExitNo;
  }

  void fix_bound() {
    ReferenceFit fit;
    settings_.bound = decimation_bound(scan_.cloud.points, *constraint_, settings_, &fit);
    print_fit(fit, epsilon_);
    if (settings_.decimator != "schroeder") log_->settle(kBoundSetting, checksum(settings_.bound));
    if (!settings_.bound.outliers.empty()) {
      fmt::print(
          "outliers       {} points farther than the tolerance from the reconstruction are left "
          "out\n",
          grouped(settings_.bound.outliers.size()));
    }
    if (settings_.epsilon_back) {
      fmt::print("reference      {} triangles; {}\n",
                 grouped(settings_.bound.reference.triangles.size()),
                 describe(topology_of(settings_.bound.reference.view())));
    }
    std::fflush(stdout);
  }

  // A run that was cut short may go on; one that ended has left what was asked for.
  void end_run() {
    said_what_is_kept_ = true;
    const bool cut_short = state_.interrupted || !state_.device_failure.empty();
    if (options_.resume.empty() && !cut_short) {
      log_->remove();
    } else if (log_->size() > 0) {
      say_what_is_kept(cut_short || state_.out_of_time ? "; the same command continues it" : "");
    }
  }

  void say_what_is_kept(std::string_view what_next) const {
    fmt::print("run            kept in {}{}\n", log_->folder().string(), what_next);
  }

  void keep(const BestMesh& best) {
    if (!certified_.within(epsilon_)) {
      throw Error(
          fmt::format("the certificate ({:.9g}) contradicts the kernel's e_max: nothing is "
                      "written; this is a defect of the program, please report it",
                      certified_.e_max_upper));
    }
    const std::string bytes = mesh_bytes(best.mesh, mesh_format(settings_.output));
    Certificate certificate;
    certificate.mesh_file = std::filesystem::path(options_.output).filename().string();
    certificate.mesh_sha256 = sha256(bytes);
    certificate.cloud_file = scan_.path.filename().string();
    certificate.cloud_sha256 = cloud_sha256_;
    certificate.skip_invalid = options_.common.skip_invalid;
    certificate.epsilon = epsilon_;
    certificate.error = in_file_indices(certified_, scan_.cloud);
    certificate.kernel = in_file_indices(best.error.kept, scan_.cloud);
    certificate.vertices = best.mesh.vertices.size();
    certificate.triangles = best.mesh.triangles.size();
    certificate.validity = validity_;
    certificate.topology = topology_;
    certificate.transform = constraint_->cloud().normalization();
    certificate.chain = best.chain;
    certificate.seed = settings_.seed;
    certificate.evaluations = state_.evaluations;
    std::vector<OutputFile> files;
    if (settings_.epsilon_back) {
      files.push_back({reference_path(options_.output),
                       mesh_bytes(settings_.bound.reference, MeshFormat::kPly)});
      certificate.reference = certified_reference(best, files.back());
    }
    files.push_back({options_.output, bytes});
    files.push_back({certificate_path(options_.output), to_json_text(certificate)});
    write_together(files);
    fmt::print("result         {}: {} triangles; {}\n", options_.output,
               grouped(best.mesh.triangles.size()), describe(validity_));
    fmt::print(
        "topology       {}\n",
        describe(topology_, certificate.reference ? std::optional(certificate.reference->topology)
                                                  : std::nullopt));
    fmt::print("e_max          {:.9g} certified, at most {:.9g} ({:.4g}% of the width)\n",
               certified_.e_max_upper, epsilon_, 100 * certified_.e_max_upper / scan_.width);
    if (certificate.reference) {
      print(*certificate.reference, epsilon_, scan_.width, files.front().path);
    }
    fmt::print("certificate    {}\n", certificate_path(options_.output).string());
    reference_ = certificate.reference;
  }

  ReferenceBound certified_reference(const BestMesh& best, const OutputFile& file) const {
    const SurfaceDistance back = decided_distance(
        best.mesh.view(), ExactMesh(settings_.bound.reference.view()), *settings_.epsilon_back);
    if (!back.within(*settings_.epsilon_back)) {
      throw Error(
          fmt::format("the certificate ({:.9g}) contradicts the decimator's bound on the distance "
                      "of the mesh to the reference: nothing is written; this is a defect of the "
                      "program, please report it",
                      back.upper));
    }
    ReferenceBound bound;
    bound.reference_to_mesh = reference_to_mesh(settings_.bound.reference, best.mesh, epsilon_);
    if (bound.reference_to_mesh > epsilon_) {
      throw Error(
          fmt::format("the certificate ({:.9g}) contradicts the decimator's bound on the distance "
                      "of the reference to the mesh: nothing is written; this is a defect of the "
                      "program, please report it",
                      bound.reference_to_mesh));
    }
    bound.topology = topology_of(settings_.bound.reference.view());
    bound.file = file.path.filename().string();
    bound.sha256 = sha256(file.bytes);
    bound.triangles = settings_.bound.reference.triangles.size();
    bound.epsilon_back = *settings_.epsilon_back;
    bound.mesh_to_reference = back.upper;
    bound.points_to_reference = certify(scan_.cloud.points, settings_.bound.reference.view(),
                                        best.error.excluded, processor_threads())
                                    .e_max_upper;
    return bound;
  }

  void refuse(const BestMesh& least) const {
    fmt::print("result         infeasible: no mesh within {:.9g} was found, none is written\n",
               epsilon_);
    if (certified_.within(epsilon_)) {
      fmt::print(
          "reference      {:.4g} times the bound is the least distance found between mesh and "
          "reference, with {} triangles; raise --max-error, raise --budget or take --bound "
          "one-sided\n",
          1 + least.violation, grouped(least.mesh.triangles.size()));
      return;
    }
    fmt::print(
        "e_max          {:.9g} is the least found ({:.4g}% of the width), with {} "
        "triangles; raise --max-error, raise --budget or exclude outliers\n",
        certified_.e_max_upper, 100 * certified_.e_max_upper / scan_.width,
        grouped(least.mesh.triangles.size()));
  }

  void print_common(const BestMesh& shown, double seconds) const {
    print_excluded(certified_, constraint_->excludable());
    fmt::print("worst point    {}\n", scan_.cloud.index_in_file(shown.error.kept.worst_point));
    fmt::print("reconstruction {} triangles, {} points left unmeshed\n",
               grouped(shown.reconstruction_triangles), grouped(shown.unmeshed_points));
    fmt::print("kernel         e_max^2 bits 0x{:08x}\n", shown.error.kept.squared_bits);
    fmt::print("evaluations    {} in {:.0f} s{}{}\n", state_.evaluations, seconds,
               describe_failures(state_),
               state_.interrupted      ? "; interrupted"
               : state_.out_of_time    ? "; out of time"
               : state_.target_reached ? "; target reached"
               : state_.stagnated      ? "; no better mesh for long"
                                       : "");
    if (state_.polished) {
      fmt::print(
          "polished       {}\n",
          shown.triangles < *state_.polished
              ? grouped(*state_.polished) + " triangles before the best mesh was decimated deep"
              : "the best mesh decimated deep has no fewer triangles");
    }
    print_shares(seconds);
    fmt::print("device {:<7} {}\n", options_.common.device, describe_counters(counters_));
    if (address_.board) print_prediction(*address_.board, *counters_, cpu_->seconds());
  }

  // Of the time that the workers had.
  void print_shares(double seconds) const {
    const double all = seconds * settings_.jobs;
    if (!(state_.stages.sum() > 0) || !(all > 0)) return;
    const auto percent = [all](double part) { return 100 * part / all; };
    fmt::print(
        "time           reconstruction {:.0f}%, holes and far points {:.0f}%, decimation {:.0f}%, "
        "distance to the reference {:.1f}%; e_max {:.2f}%\n",
        percent(state_.stages.reconstruct), percent(state_.stages.prepare),
        percent(state_.stages.decimate), percent(state_.stages.check), percent(state_.measuring));
  }

  void write_json(const BestMesh& shown) const {
    if (!json_is_wanted(options_.common.json)) return;
    ResultReport report;
    report.feasible = state_.best.has_value();
    report.validity = validity_;
    report.topology = topology_;
    report.triangles = shown.mesh.triangles.size();
    report.epsilon = epsilon_;
    report.certified = in_file_indices(certified_, scan_.cloud);
    report.kernel = in_file_indices(shown.error.kept, scan_.cloud);
    report.points = scan_.cloud.points.size();
    report.transform = constraint_->cloud().normalization();
    report.evaluations = state_.evaluations;
    report.failures = state_.failures;
    report.ended_by = ended_by(state_);
    report.seed = settings_.seed;
    report.reconstruction_triangles = shown.reconstruction_triangles;
    report.unmeshed_points = shown.unmeshed_points;
    report.device = options_.common.device;
    report.counters = counters_;
    report.board = address_.board;
    report.two_sided = settings_.epsilon_back.has_value();
    report.reference = reference_;
    if (cpu_) report.cpu_seconds = cpu_->seconds();
    emax::write_json(options_.common.json, to_json_text(report));
  }

  const OptimizeOptions& options_;
  OptimizeSettings settings_;
  DeviceAddress address_;
  std::unique_ptr<Evaluator> device_;
  Scan scan_;
  std::string cloud_sha256_;
  double epsilon_ = 0;
  std::optional<ErrorConstraint> constraint_;
  std::optional<RunLog> log_;
  bool said_what_is_kept_ = false;
  OptimizeState state_;
  std::optional<DeviceCounters> counters_;
  std::optional<CpuTwin> cpu_;               // with a board to compare with
  std::optional<ReferenceBound> reference_;  // of the mesh that was written
  MeshValidity validity_;
  MeshTopology topology_;
  CertifiedError certified_;
};

}  // namespace

int run_optimize(const OptimizeOptions& options) { return OptimizeCommand(options).run(); }

}  // namespace emax
