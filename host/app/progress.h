#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "host/optimize/optimize.h"

namespace emax {

// Shows an optimization on standard error: one line rewritten in place on a terminal, plain lines
// in a pipe (every improvement and every tenth of the budget).
class Progress {
 public:
  Progress(const ErrorConstraint& constraint, std::optional<std::chrono::duration<double>> time);
  ~Progress() { finish(); }

  void show(const OptimizeState& state);
  void finish();  // leaves the terminal on a fresh line

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(const OptimizeState& state) const;
  std::string time_left(const OptimizeState& state) const;
  std::string polishing_time() const;

  const ErrorConstraint& constraint_;
  std::optional<std::chrono::duration<double>> time_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_;
  bool terminal_;
  bool open_line_ = false;
  std::optional<std::size_t> best_triangles_;
  std::uint64_t tenth_ = 0;
  std::optional<Clock::time_point> polishing_;  // since when
};

}  // namespace emax
