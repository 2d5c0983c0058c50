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

// "45 s", "6 min", "2.5 h".
std::string rough_time(double seconds);

// The share that is done of a phase of `expected` seconds after `elapsed` seconds: from 0 to below
// 1, never falling in `elapsed`. It is nine tenths when the expected time is over, and grows ever
// more slowly after that.
double expected_share(double elapsed, double expected);

// Seconds that are left of a phase by expected_share(): all of them at its beginning.
double expected_left(double elapsed, double expected);

// Rough times of phases on one processor core. They are only shown, and decide nothing.
double reading_seconds(const std::filesystem::path& file);
double reference_seconds(std::size_t points);  // reconstruction, and joining far points
double joining_seconds(std::size_t points);  // joining far points, or assigning points to triangles
double certifying_seconds(std::size_t points);  // a mesh of about twice as many triangles

// Shows on standard error what a command is doing, for how long, and about how long it will take,
// from the second second of a phase on. On a terminal it rewrites one line; elsewhere it writes a
// line every ten seconds, and as JSON (ProgressStyle) one at the beginning and one every second. It
// runs in its own thread, so the working code need not call it. Shares never fall within a phase.
class PhaseProgress {
 public:
  PhaseProgress();
  ~PhaseProgress();
  PhaseProgress(const PhaseProgress&) = delete;
  PhaseProgress& operator=(const PhaseProgress&) = delete;

  // Begins a phase and ends the one before it. `seconds`: its expected time; 0 if it is not known.
  void begin(std::string_view what, double seconds = 0);
  // Sets the share of the phase that is done, where it is known, and a detail to show.
  void advance(double share, std::string_view detail = {});
  // Shows nothing until the next phase begins; clears a terminal's line.
  void end();

 private:
  using Clock = std::chrono::steady_clock;

  void speak();
  void tell();
  void clear_line();
  double elapsed() const;
  double seconds_left() const;  // negative where nothing is known of it
  std::string line() const;

  std::mutex mutex_;
  std::condition_variable changed_;
  const bool terminal_;
  bool leaving_ = false;
  bool open_line_ = false;
  std::string phase_, detail_;  // no phase while empty
  double expected_ = 0;
  double share_ = 0;  // the greatest that was shown
  std::optional<double> known_share_;
  Clock::time_point start_, next_;
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace emax
