#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "host/optimize/optimize.h"

namespace emax {

// Shows an optimization on standard error: on a terminal one line that is rewritten, in a pipe
// plain lines (for every improvement, every tenth of the budget and every half minute). The number
// of evaluations that is shown never falls. As JSON (ProgressStyle), a line for every news.
class Progress {
 public:
  // `seconds_left`: of a limited time; infinite without a limit. `expected`: seconds that the
  // search may take, shown until the first evaluation tells more.
  Progress(const ErrorConstraint& constraint, std::function<double()> seconds_left,
           double expected);
  ~Progress() { finish(); }

  void show(const OptimizeState& state);
  void finish();  // leaves the terminal on a fresh line

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(const OptimizeState& state) const;
  double elapsed_since(Clock::time_point start) const;
  double seconds_left(const OptimizeState& state) const;
  double polishing_seconds_left(const OptimizeState& state) const;
  std::string polishing_time(const OptimizeState& state) const;
  void tell(const OptimizeState& state) const;

  const ErrorConstraint& constraint_;
  std::function<double()> seconds_left_;
  double expected_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
  bool terminal_;
  bool open_line_ = false;
  std::optional<std::size_t> best_triangles_;
  std::uint64_t step_ = 0;                      // a tenth of the budget, or as JSON an evaluation
  std::uint64_t evaluations_ = 0;               // that was shown
  std::optional<Clock::time_point> polishing_;  // start of the last decimation
};

}  // namespace emax
