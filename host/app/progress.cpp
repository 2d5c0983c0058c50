#include "host/app/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

Progress::Progress(const ErrorConstraint& constraint, std::function<double()> seconds_left)
    : constraint_(constraint),
      seconds_left_(std::move(seconds_left)),
      terminal_(standard_error_is_terminal()) {}

double Progress::seconds_left(const OptimizeState& state) const {
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  double left = -1;
  if (state.evaluations > state.from_log) {
    left = elapsed.count() * static_cast<double>(state.budget - state.evaluations) /
           static_cast<double>(state.evaluations - state.from_log);
    left += state.polish_seconds;
  }
  if (const double until = std::max(0.0, seconds_left_()); std::isfinite(until)) {
    left = left < 0 ? until : std::min(left, until);
  }
  return left;
}

std::string Progress::time_left(const OptimizeState& state) const {
  const double left = seconds_left(state);
  return left < 0 ? "estimating the time left" : minutes(left) + " left";
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
  return fmt::format(
      "{}/{} evaluations, {}, {}", evaluations_, state.budget, best,
      polishing_ ? "decimating the best deep" + polishing_time(state) : time_left(state));
}

double Progress::polishing_seconds_left(const OptimizeState& state) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - *polishing_).count();
  const double share = expected_share(elapsed, state.polish_seconds);
  const double left = share > 0 ? elapsed * (1 - share) / share : state.polish_seconds;
  return std::min(left, std::max(0.0, seconds_left_()));
}

std::string Progress::polishing_time(const OptimizeState& state) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - *polishing_).count();
  return fmt::format(" for {}, about {} left", minutes(elapsed),
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
                 {"seconds", std::chrono::duration<double>(Clock::now() - start_).count()},
                 {"seconds_left", left >= 0 ? Json(left) : Json()},
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
