#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace emax {

// Makes a share of work done that never falls of guesses that may. Where the guess falls, as when a
// decimation begins again with smaller bounds, what was left until then is the whole of the new
// work; a share is kept for further ones.
class RisingShare {
 public:
  // The share after the next guess, 0 to 1.
  double next(double guess);

  // Of the work since the guess fell for the last time.
  double of_this_work() const { return (guess_ - first_guess_) / (1 - first_guess_); }
  bool began_again() const { return began_again_; }  // by the last guess

 private:
  double first_guess_ = 0, guess_ = 0;  // of this work
  double before_ = 0;                   // the share when this work began
  bool began_again_ = false;
};

// Shows a decimation on standard error: one line rewritten in place on a terminal, a line every ten
// seconds in a pipe.
class DecimationProgress {
 public:
  explicit DecimationProgress(std::optional<std::chrono::duration<double>> time);
  ~DecimationProgress() { finish(); }

  // `share`: of the work, as it is guessed; may fall.
  void show(double share, std::size_t triangles);
  void finish();  // leaves the terminal on a fresh line

  bool out_of_time() const { return time_ && Clock::now() - start_ > *time_; }
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(double share, std::size_t triangles) const;
  static double seconds_since(Clock::time_point begun);

  std::optional<std::chrono::duration<double>> time_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point work_begun_ = start_;  // when the guess fell for the last time
  RisingShare share_;
  Clock::time_point shown_ = start_;
  bool terminal_;
  bool open_line_ = false;
};

}  // namespace emax
