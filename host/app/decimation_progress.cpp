#include "host/app/decimation_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/app/scan.h"
#include "host/app/standard_streams.h"

namespace emax {

DecimationProgress::DecimationProgress(std::optional<std::chrono::duration<double>> time)
    : time_(time), terminal_(standard_error_is_terminal()) {}

double RisingShare::next(double guess) {
  constexpr double kSmallFall = 0.05;  // that is only a better guess of the same work
  constexpr double kOfTheRest = 0.95;
  constexpr double kLast = 0.99;
  guess = std::clamp(guess, 0.0, kLast);
  began_again_ = guess < guess_ - kSmallFall;
  const auto share = [this] { return before_ + kOfTheRest * (1 - before_) * of_this_work(); };
  if (began_again_) {
    before_ = share();
    first_guess_ = guess;
  }
  guess_ = began_again_ ? guess : std::max(guess_, guess);
  return share();
}

double DecimationProgress::seconds_since(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

double DecimationProgress::seconds() const { return seconds_since(start_); }

std::string DecimationProgress::line(double share, std::size_t triangles) const {
  const double done = share_.of_this_work();
  double left = done > 0.01 ? seconds_since(work_begun_) * (1 - done) / done : -1;
  if (time_) {
    const double until = std::max(0.0, time_->count() - seconds());
    left = left < 0 ? until : std::min(left, until);
  }
  // Rounded down: a hundred would say that the work is done.
  std::string text =
      fmt::format("{:.0f}%, {} triangles, ", std::floor(100 * share), grouped(triangles));
  if (left < 0) return text + "estimating the time left";
  const long whole = std::lround(left);
  return text + fmt::format("about {}:{:02} left", whole / 60, whole % 60);
}

void DecimationProgress::show(double share, std::size_t triangles) {
  const auto now = Clock::now();
  share = share_.next(share);
  if (share_.began_again()) work_begun_ = now;
  if (now - shown_ < std::chrono::milliseconds(terminal_ ? 100 : 10000)) return;
  shown_ = now;
  const std::string text = line(share, triangles);
  to_standard_error(terminal_ ? "\r\033[K" + fit_terminal(text) : text + "\n");
  open_line_ = terminal_;
}

void DecimationProgress::finish() {
  if (open_line_) to_standard_error("\n");
  open_line_ = false;
}

}  // namespace emax
