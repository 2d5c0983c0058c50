#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "host/app/commands.h"
#include "host/app/device_report.h"
#include "host/app/fit_report.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/phase_progress.h"
#include "host/app/progress.h"
#include "host/app/report_output.h"
#include "host/app/result_files.h"
#include "host/app/run_identity.h"
#include "host/app/search_report.h"
#include "host/app/search_settings.h"
#include "host/app/standard_streams.h"
#include "host/app/tiled_optimize.h"
#include "host/app/tolerated_meshes.h"
#include "host/files/atomic_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/files/tolerance.h"
#include "host/geometry/scan_estimate.h"
#include "host/optimize/optimize.h"
#include "host/optimize/run_bound.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Clock = std::chrono::steady_clock;

// The pause between two meshes that are written during the search: at least kLeastPause, and
// kPauses times the time that the last writing took.
constexpr std::chrono::seconds kLeastPause{2};
constexpr int kPauses = 20;

constexpr std::uint64_t kReferenceIndex = ~std::uint64_t{0};  // not the index of an evaluation

double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

class OptimizeCommand {
 public:
  explicit OptimizeCommand(const OptimizeOptions& options)
      : options_(options),
        settings_(search_settings(options)),
        address_(DeviceAddress::parse(options.common.device)),
        device_(make_evaluator(address_)) {
    const std::optional<Tolerance> given = given_tolerance(options.max_error, options.level);
    if (!given) suggest_tolerance();
    const double share = parse_share(options.common.excluded_share);
    const bool two_sided = is_two_sided(options);
    if (options.closed && !(two_sided && settings_.method == kFitMethod)) {
      throw Error(
          "--closed closes the reference surface: it needs --method fit and a two-sided bound");
    }
    const std::optional<Tolerance> reach = given_hole_reach(options.hole_reach, options.features);
    if (options.hole_reach == kNoHoleReach) settings_.hole_reach = 0;
    check_mesh_outputs(options.output, two_sided);
    if (!options.common.json.empty()) check_output(options.common.json, kJsonEndings);
    const ReportOptions& report = options.common.report;
    check_report_outputs(report);
    check_distinct({options.output, certificate_path(options.output),
                    two_sided ? reference_path(options.output) : "", options.common.json,
                    report.report, report.picture},
                   {options.common.cloud, options.config});
    check_not_among_scans(options.output, options.common.cloud);
    const std::string folder = options.resume.empty() ? options.output + ".run" : options.resume;
    check_outside({options.output, certificate_path(options.output), options.common.json,
                   report.report, report.picture},
                  folder);
    settings_.begun = begun_;
    settings_.seconds_left = [this] { return seconds_left() - writing_seconds_; };
    phase_.begin("reading the cloud", reading_seconds(options.common.cloud));
    scan_ = read_scan(options.common.cloud, options.common.reading, options.common.unit);
    cloud_sha256_ = sha256_of_input(scan_.path);
    phase_.end();
    reading_ended_ = Clock::now();
    require_unit(scan_.unit, mesh_format(options.output), options.output);
    epsilon_ = tolerance_below_width(*given, "--max-error", scan_);
    if (two_sided) settings_.epsilon_back = epsilon_;
    if (reach) settings_.hole_reach = tolerance_below_width(*reach, "--hole-reach", scan_);
    constraint_.emplace(scan_.cloud.points, epsilon_, share, options.common.brute_force);
    suit_to_cloud(settings_, options, scan_.cloud.points.size());
    log_.emplace(folder, run_settings(options, settings_, cloud_sha256_, epsilon_));
    settings_.log = &*log_;
    Settings& search = settings_.config.search;
    search.earlier_budgets = log_->give_budget(search.budget);
    print_task(given->in_unit_of(scan_.unit));
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
  [[noreturn]] void suggest_tolerance() {
    phase_.begin("reading the cloud", reading_seconds(options_.common.cloud));
    const Scan scan =
        read_scan(options_.common.cloud, options_.common.reading, options_.common.unit);
    const ScanEstimate estimate = estimate_scan(scan.cloud.points);
    const std::optional<double> suggested = suggested_tolerance(estimate);
    if (!suggested)
      throw Error("--max-error is missing; give it in the unit of the file, or as N%");
    throw Error(
        fmt::format("--max-error is missing; the points of {} are {:.3g} apart with a noise "
                    "of {:.2g}, so --max-error {:.2g}{} suits it: {}",
                    scan.path.string(), estimate.spacing, estimate.noise, *suggested,
                    scan.unit ? scan.unit->name : "", kWhySuggested));
  }

  void print_task(const Tolerance& tolerance) {
    facts_.add_passing("run", "{}", describe(*log_, settings_.config.search.budget));
    facts_.add("cloud", "{}", describe(scan_));
    print_left_out(facts_, scan_.cloud);
    print_doubtful_unit(facts_, scan_.width, scan_.unit);
    facts_.add("tolerance", "{}{}, {}", to_text(tolerance, scan_.width, scan_.unit),
               level_text(options_.level), settings_.epsilon_back ? "two-sided" : "one-sided");
    const std::size_t processes = options_.machines.processors.size();
    const std::size_t budget = settings_.config.search.budget;
    facts_.add_passing("search", "{} + {}, {} {}, seed {}, {} jobs{}, device {}", settings_.method,
                       settings_.decimator, budget, budget == 1 ? "evaluation" : "evaluations",
                       settings_.seed, settings_.jobs,
                       processes > 1 ? fmt::format(" on {} ranks", processes) : "",
                       options_.common.device);
    if (is_one_deep(options_, scan_.cloud.points.size())) {
      facts_.add_passing("effort",
                         "one deep decimation, since the cloud is large; --budget N searches");
    }
    print_expected_time();
    std::fflush(stdout);
  }

  // Rough, so in minutes.
  void print_expected_time() {
    const std::size_t points = scan_.cloud.points.size();
    expected_search_seconds_ = expected_search_seconds(settings_, options_, points, log_->size());
    const double first =
        seconds(begun_, Clock::now()) + reference_seconds(points) + certifying_seconds(points);
    const double all = first + expected_search_seconds_;
    const bool limited = options_.seconds && *options_.seconds < all;
    const double shown = limited ? *options_.seconds : all;
    facts_.add_passing(
        "takes", "{} {}{}", limited ? "at most" : "about", rough_time(shown),
        settings_.epsilon_back
            ? fmt::format(", the first certified mesh after about {}", rough_time(first))
            : "");
  }

  int search() {
    const Clock::time_point start = Clock::now();
    if (address_.board) {
      cpu_.emplace(*constraint_);
      settings_.measured = [this](MeshView mesh, const MeasuredError& error) {
        cpu_->measure(mesh, error);
      };
    }
    {
      Progress progress(*constraint_, settings_.seconds_left, expected_search_seconds_);
      state_ = optimize(scan_.cloud.points, *constraint_, device_.get(), settings_,
                        [&](const OptimizeState& state) {
                          progress.show(state);
                          write_better(state);
                        });
    }
    const double took = seconds(start, Clock::now());
    const BestMesh* best = best_mesh();
    if (best == nullptr && !state_.least_error) {
      end_run();
      give_up();
    }
    report(best, took);
    end_run();
    if (state_.interrupted) return kExitInterrupted;
    if (!state_.device_failure.empty()) {
      throw DeviceFailure(state_.device_failure +
                          "; the search ended there, with the result above");
    }
    return best != nullptr && fit_.open.empty() ? kExitOk : kExitNo;
  }

  // Reports that no evaluation made a mesh.
  [[noreturn]] void give_up() const {
    if (state_.interrupted) throw Interrupted{};
    if (!state_.device_failure.empty()) throw DeviceFailure(state_.device_failure);
    if (state_.out_of_time && state_.evaluations == 0) {
      throw Error(
          fmt::format("--time ended before the first evaluation: reading took {:.1f} s, the "
                      "evaluation {:.1f} s so far; allow for more",
                      seconds(begun_, reading_ended_), seconds(reading_ended_, Clock::now())));
    }
    throw Error(fmt::format("{}: no mesh could be made of it in {} evaluations{}",
                            scan_.path.string(), state_.evaluations, describe_failures(state_)));
  }

  // Writes the best mesh and prints the result of the search. `best` is nullptr if no mesh keeps
  // the bounds; then the mesh of the least violation is shown.
  void report(const BestMesh* best, double took) {
    phase_.begin("certifying the mesh", writing_seconds_);
    const BestMesh& shown = best != nullptr ? *best : *state_.least_error;
    const ProvenMesh proven =
        best != nullptr ? files_->write(shown, state_.evaluations) : files_->judge(shown);
    phase_.end();
    const CertifiedResult result = files_->result(shown, proven, state_.evaluations);
    const bool is_reference = best != nullptr && best->index == kReferenceIndex;
    const SearchOutcome outcome = {
        .options = options_,
        .settings = settings_,
        .state = state_,
        .excludable = constraint_->excludable(),
        .feasible = best != nullptr,
        .is_reference = is_reference,
        .shown = shown,
        .result = result,
        .planes = files_->planes(),
        .seconds = took,
        .counters = device_ ? std::optional(device_->counters()) : std::nullopt,
        .board = address_.board,
        .cpu_seconds = cpu_ ? std::optional(cpu_->seconds()) : std::nullopt};
    print(facts_, outcome);
    write_report_of(result, best != nullptr, took);
    if (json_is_wanted(options_.common.json)) {
      write_json(options_.common.json, to_json_text(report_of(outcome)));
    }
  }

  void write_report_of(const CertifiedResult& result, bool feasible, double took) {
    const ReportOptions& wanted = options_.common.report;
    if (!wanted.any()) return;
    phase_.begin("measuring for the report", certifying_seconds(scan_.cloud.points.size()));
    ReportData report =
        report_of_result(wanted, result, options_.output,
                         feasible ? files_->written() : std::optional<WrittenResult>());
    phase_.end();
    report.command = "optimize";
    report.search = evaluations_of(*log_);
    report.times.push_back({"reading", seconds(begun_, reading_ended_)});
    report.times.push_back({"search", took});
    write_report(wanted, std::move(report), facts_);
  }

  const BestMesh* best_mesh() const {
    const bool searched =
        state_.best && !(reference_ && reference_->triangles < state_.best->triangles);
    if (searched) return &*state_.best;
    return reference_ ? &*reference_ : nullptr;
  }

  // Writes the best mesh so far, in case the program is killed. There are pauses, because
  // certifying takes time.
  void write_better(const OptimizeState& state) {
    if (!state.best || state.best->mesh.triangles.empty() || state.best->index == written_) return;
    if (reference_ && reference_->triangles < state.best->triangles) return;
    const Clock::time_point start = Clock::now();
    if (start < next_write_ || seconds_left() < 3 * writing_seconds_) return;
    try {
      if (written_ || !files_->hold_fewer_than(state.best->triangles)) {
        files_->write(*state.best, state.evaluations);
      }
    } catch (const Error& error) {  // it may have another cause by the end
      to_standard_error(
          fmt::format("emax: {}; the search continues and tries again at its end\n", error.what()));
    }
    written_ = state.best->index;
    const Clock::time_point end = Clock::now();
    writing_seconds_ = seconds(start, end);
    next_write_ = end + std::max<Clock::duration>(kLeastPause, kPauses * (end - start));
  }

  void fix_bound() {
    make_bound();
    files_.emplace(options_, settings_, scan_, cloud_sha256_, *constraint_);
    print_fit(facts_, fit_, epsilon_);
    if (settings_.closed) print_closed(facts_, fit_.closed_holes, fit_.open);
    if (takes_bound(settings_.decimator)) log_->settle(kBoundSetting, checksum(settings_.bound));
    if (!settings_.bound.outliers.empty()) {
      facts_.add("outliers",
                 "{} points farther than the tolerance from the reconstruction are left out",
                 grouped(settings_.bound.outliers.size()));
    }
    if (settings_.epsilon_back) {
      const std::string written = write_reference();
      facts_.add("reference", "{}: {} triangles; {}{}", reference_path(options_.output).string(),
                 grouped(settings_.bound.reference.triangles.size()),
                 describe(files_->topology_of_reference()), written);
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

  // If the points allow it, the unchanged reference is the first result.
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

  // The folder of a run that was stopped early is kept, so that the run can be continued. A run
  // that ended removes it, unless --resume names it.
  void end_run() {
    said_what_is_kept_ = true;
    const bool cut_short = state_.interrupted || !state_.device_failure.empty();
    if (options_.resume.empty() && !cut_short) {
      log_->remove();
    } else if (log_->size() > 0) {
      say_what_is_kept(cut_short || state_.out_of_time ? "; the same command continues it" : "");
    }
  }

  void say_what_is_kept(std::string_view what_next) {
    facts_.add_passing("run", "kept in {}{}", log_->folder().string(), what_next);
  }

  const Clock::time_point begun_ = Clock::now();
  PhaseProgress phase_;
  const OptimizeOptions& options_;
  Facts facts_;
  OptimizeSettings settings_;
  DeviceAddress address_;
  std::unique_ptr<Evaluator> device_;
  Scan scan_;
  std::string cloud_sha256_;
  double epsilon_ = 0;
  double expected_search_seconds_ = 0;
  ReferenceFit fit_;
  std::optional<ErrorConstraint> constraint_;
  std::optional<RunLog> log_;
  bool said_what_is_kept_ = false;
  OptimizeState state_;
  std::optional<CpuTwin> cpu_;         // for a board to compare with
  std::optional<BestMesh> reference_;  // the reference as a result, if it is one
  std::optional<ResultFiles> files_;
  Clock::time_point reading_ended_;
  double writing_seconds_ = 0;            // time that the last certifying and writing took
  std::optional<std::uint64_t> written_;  // index of the evaluation whose mesh is written
  Clock::time_point next_write_;
};

}  // namespace

int run_optimize(const OptimizeOptions& options) {
  return options.tile_triangles > 0 ? run_optimize_in_tiles(options)
                                    : OptimizeCommand(options).run();
}

}  // namespace emax
