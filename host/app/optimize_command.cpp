#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "host/app/commands.h"
#include "host/app/device_report.h"
#include "host/app/fit_report.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/phase_progress.h"
#include "host/app/progress.h"
#include "host/app/reference_text.h"
#include "host/app/result_files.h"
#include "host/app/run_identity.h"
#include "host/app/standard_streams.h"
#include "host/files/atomic_file.h"
#include "host/files/sha256.h"
#include "host/files/tolerance.h"
#include "host/geometry/mesh_validity.h"
#include "host/optimize/optimize.h"
#include "host/optimize/run_bound.h"
#include "host/report/certificate_file.h"
#include "host/report/result_json.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"
#include "sw_model/certify/surface_distance.h"

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
  settings.seed = options.seed;
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

std::uint64_t budget_of(const OptimizeOptions& options, std::uint64_t configured,
                        std::size_t points) {
  if (options.budget) return *options.budget;
  const SearchEffort effort = options.effort == "quick"  ? SearchEffort::kQuick
                              : options.effort == "deep" ? SearchEffort::kDeep
                                                         : SearchEffort::kNormal;
  return search_budget(effort, points, options.decimator != "bounded",
                       options.config.empty() ? std::nullopt : std::optional(configured));
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

std::string_view ended_by(const OptimizeState& state) {
  if (state.interrupted) return "interrupt";
  if (!state.device_failure.empty()) return "device";
  if (state.out_of_time) return "time";
  if (state.target_reached) return "target";
  return state.stagnated ? "stagnation" : "budget";
}

using Clock = std::chrono::steady_clock;

// Between two meshes that are written during the search: so long, and so many times what writing
// the last one took.
constexpr std::chrono::seconds kLeastPause{2};
constexpr int kPauses = 20;

constexpr std::uint64_t kReferenceIndex = ~std::uint64_t{0};  // it is no evaluation's mesh

double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
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
    if (options.closed && !(two_sided && settings_.method == kFitMethod)) {
      throw Error(
          "--closed closes the reference surface: it needs --method fit and a two-sided bound");
    }
    settings_.closed = options.closed;
    check_mesh_outputs(options.output, two_sided);
    if (!options.common.json.empty()) check_output(options.common.json, kJsonEndings);
    check_distinct({options.output, certificate_path(options.output),
                    two_sided ? reference_path(options.output) : "", options.common.json},
                   {options.common.cloud, options.config});
    const std::string folder = options.resume.empty() ? options.output + ".run" : options.resume;
    check_outside({options.output, certificate_path(options.output), options.common.json}, folder);
    settings_.seconds_left = [this] { return seconds_left() - writing_seconds_; };
    phase_.begin("reading the cloud", reading_seconds(options.common.cloud));
    scan_ = read_scan(options.common.cloud, options.common.skip_invalid);
    cloud_sha256_ = sha256_of_file(scan_.path);
    phase_.end();
    reading_ended_ = Clock::now();
    epsilon_ = below_width(tolerance, "--max-error", scan_);
    if (two_sided) settings_.epsilon_back = epsilon_;
    constraint_.emplace(scan_.cloud.points, epsilon_, share, options.common.brute_force);
    files_.emplace(options_, settings_, scan_, cloud_sha256_, *constraint_);
    std::size_t& budget = settings_.config.search.budget;
    budget = budget_of(options, budget, scan_.cloud.points.size());
    settings_.limits = evaluation_limits(options, scan_.cloud.points.size());
    if (options.jobs == 0) {
      settings_.jobs = std::min(settings_.jobs, jobs_in_memory(*settings_.limits));
    }
    log_.emplace(folder, run_settings(options, settings_, cloud_sha256_, epsilon_));
    settings_.log = &*log_;
    settings_.config.search.earlier_budgets = log_->give_budget(budget);
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
      Progress progress(*constraint_, settings_.seconds_left);
      state_ = optimize(scan_.cloud.points, *constraint_, device_.get(), settings_,
                        [&](const OptimizeState& state) {
                          progress.show(state);
                          write_better(state);
                        });
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (device_) counters_ = device_->counters();
    const BestMesh* best = best_mesh();
    if (best == nullptr && !state_.least_error) {
      end_run();
      if (state_.interrupted) throw Interrupted{};
      if (!state_.device_failure.empty()) throw DeviceFailure(state_.device_failure);
      if (state_.out_of_time && state_.evaluations == 0) {
        throw Error(
            fmt::format("--time ended before the first evaluation: reading took {:.1f} s, the "
                        "evaluation {:.1f} "
                        "s so far; allow for more",
                        seconds(begun_, reading_ended_), seconds(reading_ended_, Clock::now())));
      }
      throw Error(fmt::format("{}: no mesh could be made of it in {} evaluations{}",
                              scan_.path.string(), state_.evaluations, describe_failures(state_)));
    }
    const BestMesh& shown = best != nullptr ? *best : *state_.least_error;
    phase_.begin("certifying the mesh", writing_seconds_);
    if (best != nullptr) {
      proven_ = files_->write(*best, state_.evaluations);
      phase_.end();
      print_result(*best);
    } else {
      proven_.validity = check_mesh(shown.mesh.view());
      proven_.topology = topology_of(shown.mesh.view());
      proven_.points =
          certify(scan_.cloud.points, shown.mesh.view(), shown.error.excluded, processor_threads());
      phase_.end();
      refuse(shown);
    }
    print_common(shown, took.count());
    write_json(shown);
    end_run();
    if (state_.interrupted) return kExitInterrupted;
    if (!state_.device_failure.empty()) {
      throw DeviceFailure(state_.device_failure +
                          "; the search ended there, with the result above");
    }
    return best != nullptr && fit_.open.empty() ? kExitOk : kExitNo;
  }

  const BestMesh* best_mesh() const {
    const bool searched =
        state_.best && !(reference_ && reference_->triangles < state_.best->triangles);
    if (searched) return &*state_.best;
    return reference_ ? &*reference_ : nullptr;
  }

  // The best so far, for whoever looks or kills. Now and then: certifying takes time, too.
  void write_better(const OptimizeState& state) {
    if (!state.best || state.best->mesh.triangles.empty() || state.best->index == written_) return;
    if (reference_ && reference_->triangles < state.best->triangles) return;
    const Clock::time_point start = Clock::now();
    if (start < next_write_ || seconds_left() < 3 * writing_seconds_) return;
    try {
      if (written_ || !files_->hold_fewer_than(state.best->triangles)) {
        files_->write(*state.best, state.evaluations);
      }
    } catch (const Error& error) {  // which may have passed by then
      to_standard_error(
          fmt::format("emax: {}; the search goes on, and the end tries again\n", error.what()));
    }
    written_ = state.best->index;
    const Clock::time_point end = Clock::now();
    writing_seconds_ = seconds(start, end);
    next_write_ = end + std::max<Clock::duration>(kLeastPause, kPauses * (end - start));
  }

  void fix_bound() {
    make_bound();
    print_fit(fit_, epsilon_);
    if (settings_.closed) print_closed(fit_.closed_holes, fit_.open);
    if (settings_.decimator != "schroeder") log_->settle(kBoundSetting, checksum(settings_.bound));
    if (!settings_.bound.outliers.empty()) {
      fmt::print(
          "outliers       {} points farther than the tolerance from the reconstruction are left "
          "out\n",
          grouped(settings_.bound.outliers.size()));
    }
    if (settings_.epsilon_back) {
      const std::string written = write_reference();
      fmt::print("reference      {}: {} triangles; {}{}\n",
                 reference_path(options_.output).string(),
                 grouped(settings_.bound.reference.triangles.size()),
                 describe(topology_of(settings_.bound.reference.view())), written);
    }
    std::fflush(stdout);
  }

  void make_bound() {
    OptimizeSettings limited = settings_;
    limited.interrupted = [this] { return was_interrupted() || seconds_left() <= 0; };
    phase_.begin("making the reference surface", reference_seconds(scan_.cloud.points.size()));
    try {
      settings_.bound = decimation_bound(scan_.cloud.points, *constraint_, limited, &fit_);
      if (!fit_.tried.empty()) settings_.fitted = fit_.fitted_values();
    } catch (const Interrupted&) {
      if (was_interrupted()) throw;
      throw Error(
          fmt::format("--time ended while the reference surface was made, so there is no mesh yet: "
                      "reading took "
                      "{:.1f} s, the reference {:.1f} s so far; allow for more",
                      seconds(begun_, reading_ended_), seconds(reading_ended_, Clock::now())));
    }
    phase_.end();
  }

  double seconds_left() const {
    return options_.seconds ? *options_.seconds - seconds(begun_, Clock::now()) : HUGE_VAL;
  }

  // The reference is the first result, as it is, if the points allow it.
  std::string write_reference() {
    BestMesh whole = {};
    whole.index = kReferenceIndex;
    whole.chain = {settings_.method, kNoDecimator, {}};
    whole.mesh = as_stored(settings_.bound.reference, storage_of(mesh_format(settings_.output)));
    whole.triangles = whole.mesh.triangles.size();
    whole.error = constraint_->measure(whole.mesh.view(), was_interrupted);
    if (!whole.error.feasible) {
      files_->write_reference();
      return fmt::format("; points are up to {:.4g} away",
                         constraint_->in_file_units(whole.error.kept.squared_bits));
    }
    reference_ = std::move(whole);
    if (files_->hold_fewer_than(reference_->triangles)) return "";
    const Clock::time_point start = Clock::now();
    phase_.begin("certifying the reference surface", certifying_seconds(scan_.cloud.points.size()));
    files_->write(*reference_, 0);
    phase_.end();
    writing_seconds_ = seconds(start, Clock::now());
    return fmt::format(", certified and written to {} as it is", options_.output);
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

  // Of the mesh that the search found, or of the reference where that is what there is.
  void print_result(const BestMesh& best) const {
    fmt::print("result         {}: {} triangles{}; {}\n", options_.output,
               grouped(best.mesh.triangles.size()),
               is_reference(best) ? ", the reference surface as it is" : "",
               describe(proven_.validity));
    fmt::print(
        "topology       {}\n",
        describe(proven_.topology,
                 proven_.reference ? std::optional(proven_.reference->topology) : std::nullopt));
    fmt::print("e_max          {:.9g} certified, at most {:.9g} ({:.4g}% of the width)\n",
               proven_.points.e_max_upper, epsilon_,
               100 * proven_.points.e_max_upper / scan_.width);
    if (proven_.reference) {
      print(*proven_.reference, epsilon_, scan_.width, reference_path(options_.output));
    }
    fmt::print("certificate    {}\n", certificate_path(options_.output).string());
  }

  bool is_reference(const BestMesh& best) const { return reference_ && &best == &*reference_; }

  void refuse(const BestMesh& least) const {
    fmt::print("result         infeasible: no mesh within {:.9g} was found, none is written{}\n",
               epsilon_,
               settings_.epsilon_back ? fmt::format("; the reference surface is in {}",
                                                    reference_path(options_.output).string())
                                      : "");
    if (proven_.points.within(epsilon_) && !settings_.epsilon_back) {
      fmt::print(
          "e_max          {:.9g} certified, but the tolerance is below what the kernel can tell "
          "apart; raise --max-error\n",
          proven_.points.e_max_upper);
      return;
    }
    if (proven_.points.within(epsilon_)) {
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
        proven_.points.e_max_upper, 100 * proven_.points.e_max_upper / scan_.width,
        grouped(least.mesh.triangles.size()));
  }

  void print_common(const BestMesh& shown, double seconds) const {
    print_excluded(proven_.points, constraint_->excludable());
    fmt::print("worst point    {}\n", scan_.cloud.index_in_file(shown.error.kept.worst_point));
    if (!is_reference(shown)) {
      fmt::print("reconstruction {} triangles, {} points left unmeshed\n",
                 grouped(shown.reconstruction_triangles), grouped(shown.unmeshed_points));
    }
    fmt::print("kernel         e_max^2 bits 0x{:08x}\n", shown.error.kept.squared_bits);
    const std::string stopped =
        state_.stopped > 0
            ? fmt::format(", {} more cut short with the mesh at hand", state_.stopped)
            : "";
    fmt::print("evaluations    {} in {:.0f} s{}{}{}\n", state_.evaluations, seconds, stopped,
               describe_failures(state_),
               state_.interrupted      ? "; interrupted"
               : state_.out_of_time    ? "; out of time"
               : state_.target_reached ? "; target reached"
               : state_.stagnated      ? "; no better mesh for long"
                                       : "");
    if (state_.polished) {
      fmt::print("polished       {}\n",
                 shown.triangles < *state_.polished
                     ? grouped(*state_.polished) +
                           " triangles before the best mesh was decimated deep" +
                           (state_.polish_stopped ? ", as far as the time allowed" : "")
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
    report.feasible = best_mesh() != nullptr;
    report.validity = proven_.validity;
    report.topology = proven_.topology;
    report.triangles = shown.mesh.triangles.size();
    report.epsilon = epsilon_;
    report.certified = in_file_indices(proven_.points, scan_.cloud);
    report.kernel = in_file_indices(shown.error.kept, scan_.cloud);
    report.points = scan_.cloud.points.size();
    report.transform = constraint_->cloud().normalization();
    report.evaluations = state_.evaluations;
    report.failures = state_.failures;
    report.ended_by = ended_by(state_);
    report.seed = settings_.seed;
    if (!is_reference(shown)) {
      report.reconstruction_triangles = shown.reconstruction_triangles;
      report.unmeshed_points = shown.unmeshed_points;
    }
    report.device = options_.common.device;
    report.counters = counters_;
    report.board = address_.board;
    report.two_sided = settings_.epsilon_back.has_value();
    report.reference = proven_.reference;
    if (cpu_) report.cpu_seconds = cpu_->seconds();
    emax::write_json(options_.common.json, to_json_text(report));
  }

  const Clock::time_point begun_ = Clock::now();
  PhaseProgress phase_;
  const OptimizeOptions& options_;
  OptimizeSettings settings_;
  DeviceAddress address_;
  std::unique_ptr<Evaluator> device_;
  Scan scan_;
  std::string cloud_sha256_;
  double epsilon_ = 0;
  ReferenceFit fit_;
  std::optional<ErrorConstraint> constraint_;
  std::optional<RunLog> log_;
  bool said_what_is_kept_ = false;
  OptimizeState state_;
  std::optional<DeviceCounters> counters_;
  std::optional<CpuTwin> cpu_;         // with a board to compare with
  std::optional<BestMesh> reference_;  // the reference as a result, where it is one
  ProvenMesh proven_;                  // of the mesh that is shown
  std::optional<ResultFiles> files_;
  Clock::time_point reading_ended_;
  double writing_seconds_ = 0;            // what certifying and writing took the last time
  std::optional<std::uint64_t> written_;  // index of the evaluation whose mesh is there
  Clock::time_point next_write_;
};

}  // namespace

int run_optimize(const OptimizeOptions& options) { return OptimizeCommand(options).run(); }

}  // namespace emax
