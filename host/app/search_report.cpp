#include "host/app/search_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "host/app/device_report.h"
#include "host/app/phase_progress.h"
#include "host/app/reference_text.h"

namespace emax {
namespace {

std::string_view ended_by(const OptimizeState& state) {
  if (state.interrupted) return "interrupt";
  if (!state.device_failure.empty()) return "device";
  if (state.out_of_time) return "time";
  if (state.target_reached) return "target";
  return state.stagnated ? "stagnation" : "budget";
}

double percent_of_width(const CertifiedResult& result) {
  return 100 * result.proven.points.e_max_upper / result.cloud.scan.width;
}

void print_feasible(Facts& facts, const SearchOutcome& o) {
  const std::string& output = o.options.output;
  const ProvenMesh& proven = o.result.proven;
  const double epsilon = o.result.epsilon;
  facts.add("result", "{}: {} triangles{}; {}", output, grouped(o.shown.mesh.triangles.size()),
            o.is_reference ? ", the reference surface as it is" : "", describe(proven.validity));
  facts.add("topology", "{}",
            describe(proven.topology,
                     proven.reference ? std::optional(proven.reference->topology) : std::nullopt));
  facts.add("e_max", "{:.9g} certified, at most {:.9g} ({:.4g}% of the width)",
            proven.points.e_max_upper, epsilon, percent_of_width(o.result));
  if (o.result.regions != nullptr) print(facts, *o.result.regions, o.planes);
  if (proven.reference) {
    print(facts, *proven.reference, epsilon, o.result.cloud.scan.width, reference_path(output));
  }
  facts.add("certificate", "{}", certificate_path(output).string());
}

// Prints the bound that is broken, with the remedy.
void print_infeasible(Facts& facts, const SearchOutcome& o) {
  const CertifiedError& points = o.result.proven.points;
  const double epsilon = o.result.epsilon;
  const bool two_sided = o.settings.epsilon_back.has_value();
  const std::string triangles = grouped(o.shown.mesh.triangles.size());
  facts.add("result", "infeasible: no mesh within {:.9g} was found, none is written{}", epsilon,
            two_sided ? fmt::format("; the reference surface is in {}",
                                    reference_path(o.options.output).string())
                      : "");
  if (!points.within(epsilon)) {
    facts.add("e_max",
              "{:.9g} is the least found ({:.4g}% of the width), with {} triangles; raise "
              "--max-error, raise --budget or exclude outliers",
              points.e_max_upper, percent_of_width(o.result), triangles);
  } else if (two_sided) {
    facts.add("reference",
              "{:.4g} times the bound is the least distance found between mesh and reference, with "
              "{} triangles; raise --max-error, raise --budget or take --bound one-sided",
              1 + o.shown.violation, triangles);
  } else {
    facts.add("e_max",
              "{:.9g} certified, but the tolerance is below what the kernel can tell apart; raise "
              "--max-error",
              points.e_max_upper);
  }
}

void print_evaluations(Facts& facts, const OptimizeState& state, double seconds) {
  const std::string outpaced =
      state.outpaced > 0
          ? fmt::format(", {} of them not to the end, as they would not have been the best",
                        state.outpaced)
          : "";
  const std::string stopped =
      state.stopped > 0 ? fmt::format(", {} more stopped early, with a mesh", state.stopped) : "";
  facts.add_passing("evaluations", "{} in {:.0f} s{}{}{}{}", state.evaluations, seconds, outpaced,
                    stopped, describe_failures(state),
                    state.interrupted      ? "; interrupted"
                    : state.out_of_time    ? "; out of time"
                    : state.target_reached ? "; target reached"
                    : state.stagnated      ? "; no better mesh for long"
                                           : "");
}

// Prints when there were how many triangles: of many steps the first, the last and some between.
void print_course(Facts& facts, const std::vector<FewerTriangles>& course) {
  constexpr std::size_t kMost = 6;
  if (course.empty()) return;
  std::string text;
  const std::size_t steps = std::min(course.size(), kMost);
  for (std::size_t i = 0; i < steps; ++i) {
    const auto& [seconds, triangles] =
        course[steps > 1 ? i * (course.size() - 1) / (steps - 1) : 0];
    text += fmt::format("{}{}{} after {}", i > 0 ? ", " : "", grouped(triangles),
                        i > 0 ? "" : " triangles", minutes(seconds));
  }
  facts.add_passing("course", "{}", text);
}

void print_polish(Facts& facts, const OptimizeState& state, std::size_t triangles) {
  if (!state.polished) return;
  facts.add("polished", "{}",
            triangles < *state.polished
                ? grouped(*state.polished) + " triangles before the best were decimated deep" +
                      (state.polish_stopped ? ", as far as the time allowed" : "")
                : "the best decimated deep have no fewer triangles");
}

// Prints shares of the workers' time.
void print_shares(Facts& facts, const OptimizeState& state, double all) {
  if (!(state.stages.sum() > 0) || !(all > 0)) return;
  const auto percent = [all](double part) { return 100 * part / all; };
  facts.add_passing("time",
                    "reconstruction {:.0f}%, holes and far points {:.0f}%, decimation {:.0f}%, "
                    "distance to the reference {:.1f}%; e_max {:.2f}%",
                    percent(state.stages.reconstruct), percent(state.stages.prepare),
                    percent(state.stages.decimate), percent(state.stages.check),
                    percent(state.measuring));
}

}  // namespace

std::string describe_failures(const OptimizeState& state) {
  std::string text;
  for (const auto& [reason, count] : state.failures) {
    text += fmt::format(", {} failed ({})", count, reason);
  }
  if (!state.last_failure.empty()) text += fmt::format("; last: {}", state.last_failure);
  return text;
}

void print(Facts& facts, const SearchOutcome& o) {
  o.feasible ? print_feasible(facts, o) : print_infeasible(facts, o);
  const ProvenMesh& proven = o.result.proven;
  print_excluded(facts, proven.points, o.excludable);
  facts.add("worst point", "{}", proven.kernel.worst_point);
  if (!o.is_reference) {
    facts.add("reconstruction", "{} triangles, {} points left unmeshed",
              grouped(o.shown.reconstruction_triangles), grouped(o.shown.unmeshed_points));
  }
  facts.add("kernel", "e_max^2 bits 0x{:08x}", proven.kernel.squared_bits);
  print_evaluations(facts, o.state, o.seconds);
  print_course(facts, o.state.course);
  print_polish(facts, o.state, o.shown.triangles);
  print_shares(facts, o.state, o.seconds * o.settings.jobs);
  facts.add_passing("device " + o.options.common.device, "{}", describe_counters(o.counters));
  if (o.board) print_prediction(facts, *o.board, *o.counters, *o.cpu_seconds);
}

std::vector<ReportEvaluation> evaluations_of(const RunLog& log) {
  std::vector<ReportEvaluation> list;
  std::uint64_t index = 0;
  for (const auto& [candidate, e] : log.evaluations()) {
    // Those of the end are counted on: their own indices are far beyond the others.
    index = candidate < kPolishIndex ? candidate : list.empty() ? 0 : index + 1;
    const bool failed = !e.failure.empty();
    list.push_back({index, e.seconds, failed ? std::nullopt : std::optional(e.triangles),
                    !failed && e.violation() <= 0});
  }
  return list;
}

ResultReport report_of(const SearchOutcome& o) {
  ResultReport report = report_of(o.result);
  report.feasible = o.feasible;
  report.evaluations = o.state.evaluations;
  report.failures = o.state.failures;
  report.ended_by = ended_by(o.state);
  report.seed = o.settings.seed;
  if (!o.is_reference) {
    report.reconstruction_triangles = o.shown.reconstruction_triangles;
    report.unmeshed_points = o.shown.unmeshed_points;
  }
  report.device = o.options.common.device;
  report.counters = o.counters;
  report.board = o.board;
  report.cpu_seconds = o.cpu_seconds;
  report.page = o.options.common.report.report;
  report.picture = o.options.common.report.picture;
  report.two_sided = o.settings.epsilon_back.has_value();
  return report;
}

}  // namespace emax
