#include "host/app/decimation_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/app/scan.h"
#include "host/app/standard_streams.h"

namespace emax {

DecimationProgress::DecimationProgress(std::optional<std::chrono::duration<double>> time)
    : time_(time), terminal_(standard_error_is_terminal()) {}

double DecimationProgress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

std::string DecimationProgress::line(double share, std::size_t triangles) const {
  double left = share > 0.01 ? seconds() * (1 - share) / share : -1;
  if (time_) {
    const double until = std::max(0.0, time_->count() - seconds());
    left = left < 0 ? until : std::min(left, until);
  }
  std::string text = fmt::format("{:.0f}%, {} triangles, ", 100 * share, grouped(triangles));
  if (left < 0) return text + "estimating the time left";
  const long whole = std::lround(left);
  return text + fmt::format("about {}:{:02} left", whole / 60, whole % 60);
}

void DecimationProgress::show(double share, std::size_t triangles) {
  const auto now = Clock::now();
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
