#include "tests/benchmarks/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <ostream>
#include <utility>

namespace emax::benchmarks {

std::string digits(double value) {
  const int after_point = value < 1 ? 3 : value < 10 ? 2 : value < 100 ? 1 : 0;
  return fmt::format("{:.{}f}", value, after_point);
}

std::string range(const Spread& spread) {
  return digits(spread.least) + "–" + digits(spread.greatest);
}

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

void Group::add(const std::string& way, double amount, Run run, Clock clock) {
  ways_.push_back({way, amount});
  auto* benchmark = benchmark::RegisterBenchmark((title_ + "/" + way).c_str(), std::move(run));
  if (clock == Clock::kWall) benchmark->UseRealTime();
}

void Group::add_peer(const std::string& way, double amount, Run run) {
  add(way, amount, std::move(run));
  ways_.back().peer = true;
}

void Group::add_foreign_peer(const std::string& way) { ways_.push_back({way, 1, true}); }

void Group::not_measured(const std::string& way, std::string why) {
  if (Way* found = find(way)) found->not_measured = std::move(why);
}

Way* Group::find(std::string_view way) {
  const auto found =
      std::find_if(ways_.begin(), ways_.end(), [&](const Way& w) { return w.title == way; });
  return found == ways_.end() ? nullptr : &*found;
}

const Way* Group::find(std::string_view way) const { return const_cast<Group*>(this)->find(way); }

bool Group::record(std::string_view way, double seconds) {
  Way* found = find(way);
  if (found == nullptr) return false;
  found->times.push_back(seconds * units_per_second_ / found->units_per_iteration);
  return true;
}

bool Group::record_benchmark(const std::string& benchmark_name, double seconds) {
  std::string_view name = benchmark_name;
  constexpr std::string_view kWallMark = "/real_time";
  if (name.ends_with(kWallMark)) name.remove_suffix(kWallMark.size());
  if (!name.starts_with(title_ + "/")) return false;
  return record(name.substr(title_.size() + 1), seconds);
}

std::optional<Spread> Group::time(std::string_view way) const {
  const Way* found = find(way);
  if (found == nullptr || found->times.empty()) return std::nullopt;
  return spread_of(found->times);
}

std::vector<double> Group::ratios(std::string_view way, std::string_view reference) const {
  const Way *over = find(way), *under = find(reference);
  std::vector<double> result;
  if (over == nullptr || under == nullptr || over->times.size() != under->times.size()) return {};
  for (std::size_t i = 0; i < over->times.size(); ++i) {
    result.push_back(over->times[i] / under->times[i]);
  }
  return result;
}

std::vector<double> Group::speedups(std::string_view way) const {
  const Way* found = find(way);
  std::vector<double> result;
  for (std::size_t round = 0; found != nullptr && round < found->times.size(); ++round) {
    double fastest = std::numeric_limits<double>::infinity();
    for (const Way& other : ways_) {
      if (other.peer && round < other.times.size()) fastest = std::min(fastest, other.times[round]);
    }
    if (fastest < std::numeric_limits<double>::infinity()) {
      result.push_back(fastest / found->times[round]);
    }
  }
  return result;
}

std::optional<Spread> Group::ratio(std::string_view way) const {
  std::vector<double> all = ratios(way, ways_.front().title);
  if (all.empty()) return std::nullopt;
  return spread_of(std::move(all));
}

void Group::write(std::ostream& out) const {
  if (std::all_of(ways_.begin(), ways_.end(), [](const Way& w) { return w.times.empty(); })) return;
  const bool first = reference_ == Reference::kFirstWay;
  out << fmt::format("\n## {}\n\n{}\n\n| way | {} | least–greatest | {} | least–greatest |\n",
                     title_, text_, unit_,
                     first ? "of the first row" : "the fastest exact peer takes, times as long");
  out << "|---|---:|---:|---:|---:|\n";
  for (const Way& way : ways_) {
    if (way.times.empty()) {
      if (!way.not_measured.empty()) {
        out << fmt::format("| {} | not measured: {} | | | |\n", way.title, way.not_measured);
      }
      continue;
    }
    const Spread time = spread_of(way.times);
    out << fmt::format("| {} | {} | {} |", way.title, digits(time.median), range(time));
    const std::vector<double> against =
        first ? ratios(way.title, ways_.front().title) : speedups(way.title);
    if (against.empty()) {
      out << " | |\n";
    } else if (first && &way == &ways_.front()) {
      out << " 1 | |\n";
    } else {
      out << fmt::format(" {} | {} |\n", digits(spread_of(against).median),
                         range(spread_of(against)));
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
    const bool wall = run.benchmark_name().ends_with("/real_time");
    const double seconds = (wall ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime()) /
                           benchmark::GetTimeUnitMultiplier(run.time_unit);
    const bool recorded =
        !run.error_occurred && std::any_of(groups_.begin(), groups_.end(), [&](Group& group) {
          return group.record_benchmark(run.benchmark_name(), seconds);
        });
    if (!recorded) failed_ = true;
  }
  ConsoleReporter::ReportRuns(runs);
}

}  // namespace emax::benchmarks
