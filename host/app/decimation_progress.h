#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "host/app/phase_progress.h"

namespace emax {

// Turns guesses of a share of work, which may fall, into a share that never falls. A guess falls
// when a decimation starts again with smaller bounds. The rest of the share is then the whole of
// the new work, except a part that is kept for further starts.
class RisingShare {
 public:
  // The share after the next guess, 0 to 1.
  double next(double guess);

  // The share of the work since the guess fell last.
  double of_this_work() const { return (guess_ - first_guess_) / (1 - first_guess_); }
  bool began_again() const { return began_again_; }  // by the last guess

 private:
  double first_guess_ = 0, guess_ = 0;  // of this work
  double before_ = 0;                   // the share when this work started
  bool began_again_ = false;
};

// Shows the progress of a command on standard error, from the reading of files on, and measures its
// time against a limit.
class DecimationProgress {
 public:
  explicit DecimationProgress(std::optional<std::chrono::duration<double>> time) : time_(time) {}

  // See PhaseProgress.
  void begin(const char* phase, double seconds);
  // `share`: the guessed share of the decimation's work; it may fall.
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
