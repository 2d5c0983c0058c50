#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "host/app/phase_progress.h"

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

// The progress of a decimation on standard error, from its beginning with the reading of files, and
// the time that it may take in all.
class DecimationProgress {
 public:
  explicit DecimationProgress(std::optional<std::chrono::duration<double>> time) : time_(time) {}

  // See PhaseProgress.
  void begin(const char* phase, double seconds);
  // `share`: of the decimation's work, as it is guessed; may fall.
  void show(double share, std::size_t triangles);
  void finish() { phase_.end(); }

  bool out_of_time() const { return time_ && seconds() > time_->count(); }
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<std::chrono::duration<double>> time_;
  const Clock::time_point start_ = Clock::now();
  bool decimating_ = false;
  RisingShare share_;
  PhaseProgress phase_;
};

}  // namespace emax
