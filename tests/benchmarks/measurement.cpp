#include "tests/benchmarks/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <utility>

namespace emax::benchmarks {

namespace {

// Three digits, never an exponent.
std::string digits(double value) {
  const int after_point = value < 1 ? 3 : value < 10 ? 2 : value < 100 ? 1 : 0;
  return fmt::format("{:.{}f}", value, after_point);
}

std::string range(const Spread& spread) {
  return digits(spread.least) + "–" + digits(spread.greatest);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

void Group::add(const std::string& way, double amount, std::function<void(benchmark::State&)> run) {
  ways_.push_back({way, amount, {}});
  benchmark::RegisterBenchmark((title_ + "/" + way).c_str(), std::move(run));
}

bool Group::record(const std::string& benchmark_name, double seconds) {
  for (Way& way : ways_) {
    if (benchmark_name != title_ + "/" + way.title) continue;
    way.times.push_back(seconds * units_per_second_ / way.units_per_iteration);
    return true;
  }
  return false;
}

std::optional<Spread> Group::ratio(const Way& way) const {
  const std::vector<double>& reference = ways_.front().times;
  if (way.times.empty() || way.times.size() != reference.size()) return std::nullopt;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    ratios.push_back(way.times[i] / reference[i]);
  }
  return spread_of(std::move(ratios));
}

std::optional<Spread> Group::ratio(const std::string& title) const {
  for (const Way& way : ways_) {
    if (way.title == title) return ratio(way);
  }
  return std::nullopt;
}

void Group::write(std::ostream& out) const {
  if (std::all_of(ways_.begin(), ways_.end(), [](const Way& w) { return w.times.empty(); })) return;
  out << fmt::format(
      "\n## {}\n\n{}\n\n| way | {} | least–greatest | of the first row | least–greatest |\n",
      title_, text_, unit_);
  out << "|---|---:|---:|---:|---:|\n";
  for (const Way& way : ways_) {
    if (way.times.empty()) continue;
    const Spread time = spread_of(way.times);
    out << fmt::format("| {} | {} | {} |", way.title, digits(time.median), range(time));
    const std::optional<Spread> against = ratio(way);
    if (against && &way != &ways_.front()) {
      out << fmt::format(" {} | {} |\n", digits(against->median), range(*against));
    } else {
      out << (against ? " 1 | |\n" : " | |\n");
    }
  }
}

bool RecordingReporter::ReportContext(const Context& context) {
  return std::exchange(context_shown_, true) || ConsoleReporter::ReportContext(context);
}

void RecordingReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    empty_ = false;
    const double seconds =
        run.GetAdjustedCPUTime() / benchmark::GetTimeUnitMultiplier(run.time_unit);
    const bool recorded =
        !run.error_occurred && std::any_of(groups_.begin(), groups_.end(), [&](Group& group) {
          return group.record(run.benchmark_name(), seconds);
        });
    if (!recorded) failed_ = true;
  }
  ConsoleReporter::ReportRuns(runs);
}

}  // namespace emax::benchmarks
