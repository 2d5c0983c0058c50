#include "host/app/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/app/phase_progress.h"
#include "host/app/progress_style.h"
#include "host/app/scan.h"
#include "host/app/standard_streams.h"
#include "host/report/json_parts.h"

namespace emax {
namespace {

constexpr std::chrono::milliseconds kOnTerminal{100};
constexpr std::chrono::seconds kInPipe{30};  // without news

}  // namespace

Progress::Progress(const ErrorConstraint& constraint, std::function<double()> seconds_left,
                   double expected)
    : constraint_(constraint),
      seconds_left_(std::move(seconds_left)),
      expected_(expected),
      terminal_(standard_error_is_terminal()) {}

double Progress::elapsed_since(Clock::time_point start) const {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double Progress::seconds_left(const OptimizeState& state) const {
  const double elapsed = elapsed_since(start_);
  double left = expected_left(elapsed, expected_);
  if (state.evaluations > state.from_log) {
    left = elapsed * static_cast<double>(state.budget - state.evaluations) /
           static_cast<double>(state.evaluations - state.from_log);
    left += state.polish_seconds;
  }
  return std::min(left, std::max(0.0, seconds_left_()));
}

std::string Progress::line(const OptimizeState& state) const {
  std::string best = "nothing measured yet";
  if (state.best) {
    best = fmt::format("best {} triangles, e_max {:.4g} of {:.4g}", grouped(state.best->triangles),
                       constraint_.in_file_units(state.best->squared_bits), constraint_.epsilon());
  } else if (state.least_error) {
    best = fmt::format("none within {:.4g} yet, least e_max {:.4g}", constraint_.epsilon(),
                       constraint_.in_file_units(state.least_error->squared_bits));
  }
  return fmt::format("{}/{} evaluations, {}, {}", evaluations_, state.budget, best,
                     polishing_ ? "decimating the best deep" + polishing_time(state)
                                : "about " + minutes(seconds_left(state)) + " left");
}

double Progress::polishing_seconds_left(const OptimizeState& state) const {
  const double left = expected_left(elapsed_since(*polishing_), state.polish_seconds);
  return std::min(left, std::max(0.0, seconds_left_()));
}

std::string Progress::polishing_time(const OptimizeState& state) const {
  return fmt::format(" for {}, about {} left", minutes(elapsed_since(*polishing_)),
                     minutes(polishing_seconds_left(state)));
}

void Progress::tell(const OptimizeState& state) const {
  const double left = polishing_ ? polishing_seconds_left(state) : seconds_left(state);
  Json triangles, error;
  if (const auto& shown = state.best ? state.best : state.least_error) {
    error = constraint_.in_file_units(shown->squared_bits);
  }
  if (state.best) triangles = state.best->triangles;
  tell_progress({{"phase", polishing_ ? "decimating the best deep" : "search"},
                 {"seconds", elapsed_since(start_)},
                 {"seconds_left", left},
                 {"evaluations", evaluations_},
                 {"budget", state.budget},
                 {"triangles", triangles},
                 {"e_max", error}});
}

void Progress::show(const OptimizeState& state) {
  const auto now = Clock::now();
  evaluations_ = std::max(evaluations_, state.evaluations);
  const bool begins_polishing = state.polishing && !polishing_;
  if (begins_polishing) polishing_ = now;
  const std::optional<std::size_t> triangles =
      state.best ? std::optional(state.best->triangles) : std::nullopt;
  const bool as_json = progress_style() == ProgressStyle::kJson;
  if (progress_style() == ProgressStyle::kNone) return;
  if (terminal_ && !as_json) {
    if (now - shown_ < kOnTerminal) return;
    to_standard_error("\r\033[K" + fit_terminal(line(state)));
    open_line_ = true;
    shown_ = now;
    return;
  }
  const std::uint64_t steps = as_json ? state.budget : 10;
  const std::uint64_t step = steps * evaluations_ / std::max<std::uint64_t>(state.budget, 1);
  const bool news = triangles != best_triangles_ || step != step_ || begins_polishing;
  if (!news && now - shown_ < kInPipe) return;
  best_triangles_ = triangles;
  step_ = step;
  shown_ = now;
  if (as_json) return tell(state);
  to_standard_error(line(state) + "\n");
}

void Progress::finish() {
  if (open_line_) to_standard_error("\n");
  open_line_ = false;
}

}  // namespace emax
