#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace emax {

// 75 as "1:15".
std::string minutes(double seconds);

// How a phase of so many expected seconds stands after so many: from 0 to below 1, never falling in
// `elapsed`. Nine tenths of it when the time is over, and less and less after that.
double expected_share(double elapsed, double expected);

// What phases take, roughly, on one processor core: to be shown, and to decide nothing.
double reading_seconds(const std::filesystem::path& file);
double reference_seconds(std::size_t points);   // reconstruction, far points joined
double joining_seconds(std::size_t points);     // far points alone, or points given to triangles
double certifying_seconds(std::size_t points);  // a mesh of about twice as many triangles

// Says on standard error what a command is doing, how long it has been at it and about how long it
// will take, from the second second of a phase on: one line rewritten in place on a terminal, a
// line every ten seconds elsewhere. It speaks from a thread of its own, so whoever works need not.
// Shares never fall within a phase.
class PhaseProgress {
 public:
  PhaseProgress();
  ~PhaseProgress();
  PhaseProgress(const PhaseProgress&) = delete;
  PhaseProgress& operator=(const PhaseProgress&) = delete;

  // The phase before it has ended. `seconds`: what it is expected to take; 0 where nobody knows.
  void begin(std::string_view what, double seconds = 0);
  // The share of the phase that is done, where that is known, and what else is to be said.
  void advance(double share, std::string_view detail = {});
  // Nothing is said any more, until the next phase begins; a terminal's line is cleared.
  void end();

 private:
  using Clock = std::chrono::steady_clock;

  void speak();
  void clear_line();
  std::string line() const;

  std::mutex mutex_;
  std::condition_variable changed_;
  const bool terminal_;
  bool leaving_ = false;
  bool open_line_ = false;
  std::string phase_, detail_;  // no phase while empty
  double expected_ = 0;
  double share_ = 0;  // the greatest that was said
  std::optional<double> known_share_;
  Clock::time_point start_, next_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace emax
