#include "host/app/phase_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <system_error>

#include "host/app/progress_style.h"
#include "host/app/standard_streams.h"
#include "host/optimize/evaluation_limits.h"

namespace emax {
namespace {

constexpr std::chrono::milliseconds kSilence{1500};  // at the beginning of a phase
constexpr std::chrono::milliseconds kRedraw{200};
constexpr std::chrono::seconds kElsewhere{10};
constexpr std::chrono::seconds kAsJson{1};

}  // namespace

std::string minutes(double seconds) {
  const long whole = std::lround(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string rough_time(double seconds) {
  constexpr double kMinute = 60, kHour = 3600, kInSeconds = 100, kInMinutes = 6000;
  if (seconds < kInSeconds) return fmt::format("{:.0f} s", 5 * std::ceil(seconds / 5));
  if (seconds < kInMinutes) return fmt::format("{:.0f} min", seconds / kMinute);
  return fmt::format("{:.1f} h", seconds / kHour);
}

double expected_share(double elapsed, double expected) {
  constexpr double kKnown = 0.9;  // share of the phase that the expected time covers
  if (!(expected > 0)) return 0;
  const double part = elapsed / expected;
  if (part <= 1) return kKnown * part;
  return 1 - (1 - kKnown) * std::exp(1 - part);
}

double expected_left(double elapsed, double expected) {
  const double share = expected_share(elapsed, expected);
  return share > 0 ? elapsed * (1 - share) / share : expected;
}

double reading_seconds(const std::filesystem::path& file) {
  constexpr double kBytesPerSecond = 3e7;  // of text
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
  return unknown ? 0 : static_cast<double>(bytes) / kBytesPerSecond;
}

double reference_seconds(std::size_t points) {
  return 1.5e-4 * static_cast<double>(points_of_reference(points)) + joining_seconds(points);
}

double joining_seconds(std::size_t points) { return 6e-6 * static_cast<double>(points); }

double certifying_seconds(std::size_t points) { return 2e-6 * static_cast<double>(points); }

PhaseProgress::PhaseProgress()
    : terminal_(standard_error_is_terminal()), thread_([this] { speak(); }) {}

PhaseProgress::~PhaseProgress() {
  {
    const std::scoped_lock lock(mutex_);
    leaving_ = true;
    clear_line();
  }
  changed_.notify_all();
  thread_.join();
}

void PhaseProgress::begin(std::string_view what, double seconds) {
  {
    const std::scoped_lock lock(mutex_);
    clear_line();
    phase_ = what;
    detail_.clear();
    expected_ = seconds;
    share_ = 0;
    known_share_.reset();
    start_ = Clock::now();
    next_ = start_ + kSilence;
    if (progress_style() == ProgressStyle::kJson) tell();
  }
  changed_.notify_all();
}

void PhaseProgress::advance(double share, std::string_view detail) {
  const std::scoped_lock lock(mutex_);
  known_share_ = share;
  detail_ = detail;
}

void PhaseProgress::end() {
  const std::scoped_lock lock(mutex_);
  clear_line();
  phase_.clear();
}

void PhaseProgress::clear_line() {
  if (open_line_) to_standard_error("\r\033[K");
  open_line_ = false;
}

double PhaseProgress::elapsed() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

double PhaseProgress::seconds_left() const {
  constexpr double kTooEarly = 0.005;
  return share_ > kTooEarly ? elapsed() * (1 - share_) / share_ : -1;
}

std::string PhaseProgress::line() const {
  std::string text = fmt::format("{}: {}", phase_, minutes(elapsed()));
  if (const double left = seconds_left(); left >= 0) {
    text += fmt::format(", {:.0f}%, about {} left", std::floor(100 * share_), minutes(left));
  } else {
    text += ", estimating the time left";
  }
  return detail_.empty() ? text : text + ", " + detail_;
}

void PhaseProgress::tell() {
  if (progress_style() == ProgressStyle::kJson) {
    const double left = seconds_left();
    tell_progress({{"phase", phase_},
                   {"seconds", elapsed()},
                   {"share", share_},
                   {"seconds_left", left >= 0 ? nlohmann::ordered_json(left) : nullptr},
                   {"detail", detail_}});
    next_ = Clock::now() + kAsJson;
    return;
  }
  to_standard_error(terminal_ ? "\r\033[K" + fit_terminal(line()) : line() + "\n");
  open_line_ = terminal_;
  next_ = Clock::now() + (terminal_ ? Clock::duration(kRedraw) : Clock::duration(kElsewhere));
}

void PhaseProgress::speak() {
  sigset_t all;  // other threads handle signals
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  std::unique_lock lock(mutex_);
  while (!leaving_) {
    if (phase_.empty() || progress_style() == ProgressStyle::kNone) {
      changed_.wait(lock);
      continue;
    }
    if (Clock::now() < next_) {
      changed_.wait_until(lock, next_);
      continue;  // the phase may have changed
    }
    share_ = std::max(share_, known_share_.value_or(expected_share(elapsed(), expected_)));
    tell();
  }
}

}  // namespace emax
