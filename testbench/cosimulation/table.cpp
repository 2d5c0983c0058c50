#include "testbench/cosimulation/table.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace emax {
namespace {

void print_line(const TestReport& report, const std::string& seed) {
  char interval[16] = "-", coverage[16] = "-";
  if (report.coverage) std::snprintf(coverage, sizeof coverage, "%.2f %%", *report.coverage);
  if (report.initiation_interval) {
    std::snprintf(interval, sizeof interval, "%.3f", *report.initiation_interval);
  }
  const double rate = report.simulating_seconds > 0
                          ? static_cast<double>(report.pairs) / report.simulating_seconds
                          : 0;
  std::printf("%-36s %20s %11llu %8llu %10llu %9s %11llu %6s %7.1f %9.0f\n", report.name.c_str(),
              seed.c_str(), static_cast<unsigned long long>(report.pairs),
              static_cast<unsigned long long>(report.blocks),
              static_cast<unsigned long long>(report.mismatches), coverage,
              static_cast<unsigned long long>(report.cycles), interval, report.seconds, rate);
  std::fflush(stdout);
}

void clear_progress() {
  if (isatty(STDOUT_FILENO) != 0) std::printf("\r\033[K");
}

}  // namespace

void Table::print_head() const {
  std::printf("%-36s %20s %11s %8s %10s %9s %11s %6s %7s %9s\n", "test", "seed", "pairs", "blocks",
              "mismatches", "coverage", "cycles", "II", "time/s", "pairs/s");
}

void Table::print_row(const TestReport& report) {
  clear_progress();
  print_line(report, std::to_string(report.seed));
  sum_.pairs += report.pairs;
  sum_.blocks += report.blocks;
  sum_.cycles += report.cycles;
  sum_.seconds += report.seconds;
  sum_.simulating_seconds += report.simulating_seconds;
  sum_.mismatches += report.mismatches;
}

void Table::print_sum() const {
  TestReport sum = sum_;
  sum.name = "all";
  print_line(sum, "");
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
