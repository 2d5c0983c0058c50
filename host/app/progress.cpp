#include "host/app/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/app/scan.h"
#include "host/app/standard_streams.h"

namespace emax {
namespace {

std::string minutes(std::chrono::duration<double> time) {
  const long seconds = std::lround(time.count());
  return fmt::format("{}:{:02}", seconds / 60, seconds % 60);
}

}  // namespace

Progress::Progress(const ErrorConstraint& constraint,
                   std::optional<std::chrono::duration<double>> time)
    : constraint_(constraint), time_(time), terminal_(standard_error_is_terminal()) {}

std::string Progress::time_left(const OptimizeState& state) const {
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  double left = -1;
  if (state.evaluations > state.from_log) {
    left = elapsed.count() * static_cast<double>(state.budget - state.evaluations) /
           static_cast<double>(state.evaluations - state.from_log);
  }
  if (time_) {
    const double until = std::max(0.0, (*time_ - elapsed).count());
    left = left < 0 ? until : std::min(left, until);
  }
  if (left < 0) return "estimating the time left";
  return minutes(std::chrono::duration<double>(left)) + " left";
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
  return fmt::format("{}/{} evaluations, {}, {}", state.evaluations, state.budget, best,
                     polishing_ ? "decimating it deep" + polishing_time() : time_left(state));
}

std::string Progress::polishing_time() const {
  return terminal_ ? " for " + minutes(Clock::now() - *polishing_) : std::string();
}

void Progress::show(const OptimizeState& state) {
  const auto now = Clock::now();
  const bool begins_polishing = state.polishing && !polishing_;
  if (begins_polishing) polishing_ = now;
  const std::optional<std::size_t> triangles =
      state.best ? std::optional(state.best->triangles) : std::nullopt;
  if (terminal_) {
    if (now - shown_ < std::chrono::milliseconds(100)) return;
    to_standard_error("\r\033[K" + fit_terminal(line(state)));
    open_line_ = true;
    shown_ = now;
    return;
  }
  const std::uint64_t tenth = 10 * state.evaluations / std::max<std::uint64_t>(state.budget, 1);
  if (triangles == best_triangles_ && tenth == tenth_ && !begins_polishing) return;
  best_triangles_ = triangles;
  tenth_ = tenth;
  to_standard_error(line(state) + "\n");
}

void Progress::finish() {
  if (open_line_) to_standard_error("\n");
  open_line_ = false;
}

}  // namespace emax
