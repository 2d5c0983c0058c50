#include "testbench/table.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace emax {
namespace {

void print_line(const TestReport& report, const std::string& seed, std::uint64_t mismatches) {
  char interval[16] = "-";
  if (report.initiation_interval) {
    std::snprintf(interval, sizeof interval, "%.3f", *report.initiation_interval);
  }
  const double rate = report.simulating_seconds > 0
                          ? static_cast<double>(report.pairs) / report.simulating_seconds
                          : 0;
  std::printf("%-34s %20s %10llu %8llu %5llu %11llu %6s %7.1f %9.0f\n", report.name.c_str(),
              seed.c_str(), static_cast<unsigned long long>(report.pairs),
              static_cast<unsigned long long>(report.blocks),
              static_cast<unsigned long long>(mismatches),
              static_cast<unsigned long long>(report.cycles), interval, report.seconds, rate);
  std::fflush(stdout);
}

void clear_progress() {
  if (isatty(STDOUT_FILENO) != 0) std::printf("\r\033[K");
}

}  // namespace

void Table::print_head() const {
  std::printf("%-34s %20s %10s %8s %5s %11s %6s %7s %9s\n", "test", "seed", "pairs", "blocks",
              "wrong", "cycles", "II", "time/s", "pairs/s");
}

void Table::print_row(const TestReport& report) {
  const std::uint64_t mismatches = report.failure ? 1 : 0;
  clear_progress();
  print_line(report, std::to_string(report.seed), mismatches);
  sum_.pairs += report.pairs;
  sum_.blocks += report.blocks;
  sum_.cycles += report.cycles;
  sum_.seconds += report.seconds;
  sum_.simulating_seconds += report.simulating_seconds;
  mismatches_ += mismatches;
}

void Table::print_sum() const {
  TestReport sum = sum_;
  sum.name = "all";
  print_line(sum, "", mismatches_);
}

void Table::show_progress(const std::string& test, double share) {
  if (isatty(STDOUT_FILENO) == 0) return;
  const double now =
      std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  if (now - last_shown_ < 0.25) return;
  last_shown_ = now;
  std::printf("\r\033[K%s: %.0f %%", test.c_str(), 100 * share);
  std::fflush(stdout);
}

}  // namespace emax
