#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace emax {

// Shows a decimation on standard error: one line rewritten in place on a terminal, a line every ten
// seconds in a pipe.
class DecimationProgress {
 public:
  explicit DecimationProgress(std::optional<std::chrono::duration<double>> time);
  ~DecimationProgress() { finish(); }

  // `share`: of the work, as it is guessed.
  void show(double share, std::size_t triangles);
  void finish();  // leaves the terminal on a fresh line

  bool out_of_time() const { return time_ && Clock::now() - start_ > *time_; }
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(double share, std::size_t triangles) const;

  std::optional<std::chrono::duration<double>> time_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
  bool terminal_;
  bool open_line_ = false;
};

}  // namespace emax
